// How the time of a sweep depends on the number of threads, up to 16, computed from the times of the tasks of its
// parallel loops on one thread (CSV). Needs a build with RILO_RECORD_LOOPS: the preset `loops`.
#include <algorithm>
#include <array>
#include <exception>
#include <iostream>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cloud/loop_record.hpp"
#include "io/steady_clock.hpp"
#include "loop_schedule.hpp"
#include "rilo/io/scan_source.hpp"
#include "rilo/odometry/odometry.hpp"

namespace rilo::bench {
namespace {

constexpr std::array kThreads = {1, 2, 4, 8, 16, kUnlimitedThreads};

struct Stretch {
  std::string drive;
  std::size_t warm_up = 20;   // sweeps before the measured ones
  std::size_t measured = 40;  // sweeps
  std::size_t runs = 5;       // of each sweep the fastest one counts
  std::optional<double> wake_us;
};

/// A sweep on one thread.
struct RecordedSweep {
  std::int64_t begin_ns = 0;
  StageTimes times;
  std::vector<RecordedLoop> loops;
};

/// Time by number of threads, ns, and how many loops and tasks it consists of.
struct Prediction {
  std::array<double, kThreads.size()> ns{};
  double serial_ns = 0;
  std::size_t loops = 0;
  std::size_t tasks = 0;

  void add(const RecordedLoop& loop, const ThreadCost& cost) {
    for (std::size_t i = 0; i < ns.size(); ++i) {
      ns[i] += makespan_ns(loop.task_ns, kThreads[i], cost);
    }
    ++loops;
    tasks += loop.task_ns.size();
  }

  void add_serial(double more_ns) {
    serial_ns += more_ns;
    for (double& each : ns) {
      each += more_ns;
    }
  }
};

std::vector<Sweep> read(const Stretch& stretch) {
  const std::unique_ptr<ScanSource> source = open_scan_source(stretch.drive);
  std::vector<Sweep> sweeps;
  while (sweeps.size() < stretch.warm_up + stretch.measured) {
    std::optional<Sweep> sweep = source->next();
    if (!sweep) {
      throw std::runtime_error(stretch.drive + ": only " + std::to_string(sweeps.size()) + " sweeps");
    }
    sweeps.push_back(std::move(*sweep));
  }
  return sweeps;
}

/// The measured sweeps on so many threads, each at its fastest; recorded ones with their loops.
std::vector<RecordedSweep> run(const std::vector<Sweep>& sweeps, const Stretch& stretch, int threads, bool recorded) {
  std::vector<RecordedSweep> fastest(stretch.measured);
  OdometryConfig config;
  config.threads = threads;
  for (std::size_t k = 0; k < stretch.runs; ++k) {
    std::optional<LoopRecord> record;
    if (recorded) {
      record.emplace(steady_ns);
    }
    Odometry odometry(config, steady_ns);
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
      RecordedSweep sweep;
      sweep.begin_ns = steady_ns();
      sweep.times = odometry.register_sweep(sweeps[i]).stats.times;
      if (record) {
        sweep.loops = record->take();
      }
      if (i >= stretch.warm_up) {
        RecordedSweep& best = fastest[i - stretch.warm_up];
        if (k == 0 || sweep.times.total_ms < best.times.total_ms) {
          best = std::move(sweep);
        }
      }
    }
  }
  return fastest;
}

/// The function that a loop is in, from GCC's signature of its body.
std::string function_of(const RecordedLoop& loop) {
  static const std::regex kBody(
      R"(Body = (?:for_fixed_chunks<>\(std::size_t, const |for_fixed_chunks<\d+, )?((?:\{anonymous\}::)?[\w:]+))");
  std::cmatch match;
  return std::regex_search(loop.name, match, kBody) ? match[1].str() : loop.name;
}

/// Whole sweeps, their stages, and the loops by function.
std::map<std::string, Prediction> predict(const std::vector<RecordedSweep>& sweeps, const ThreadCost& cost) {
  std::map<std::string, Prediction> out;
  for (const RecordedSweep& sweep : sweeps) {
    const StageTimes& t = sweep.times;
    const std::array<std::pair<const char*, double>, 5> stages = {
        {{"stage 1 preparing", t.preprocess_ms},
         {"stage 2 initial pose", t.initial_pose_ms},
         {"stage 3 registration", t.registration_ms},
         {"stage 4 map and calibration", t.map_ms},
         {"stage 5 rest", t.total_ms - t.preprocess_ms - t.initial_pose_ms - t.registration_ms - t.map_ms}}};
    auto loop = sweep.loops.begin();
    auto end_ns = static_cast<double>(sweep.begin_ns);
    for (const auto& [name, stage_ms] : stages) {
      Prediction& stage = out[name];
      end_ns += stage_ms * 1e6;
      double serial_ns = stage_ms * 1e6;
      for (; loop != sweep.loops.end() && static_cast<double>(loop->begin_ns) < end_ns; ++loop) {
        for (Prediction* sum : {&stage, &out["sweep"], &out["loop " + function_of(*loop)]}) {
          sum->add(*loop, cost);
        }
        serial_ns -= makespan_ns(loop->task_ns, 1, cost);
      }
      stage.add_serial(serial_ns);
      out["sweep"].add_serial(serial_ns);
    }
  }
  return out;
}

double mean_ms(const std::vector<RecordedSweep>& sweeps) {
  double sum_ms = 0;
  for (const RecordedSweep& sweep : sweeps) {
    sum_ms += sweep.times.total_ms;
  }
  return sum_ms / static_cast<double>(sweeps.size());
}

void study(const Stretch& stretch, std::ostream& out) {
  const std::vector<Sweep> sweeps = read(stretch);
  ThreadCost cost = measured_thread_cost();
  if (stretch.wake_us) {
    cost.wake_ns = *stretch.wake_us * 1e3;
  }
  const std::map<std::string, Prediction> predictions = predict(run(sweeps, stretch, 1, true), cost);
  out << "# " << stretch.drive << "\n# a thread wakes up in " << cost.wake_ns << " ns, task " << cost.task_ns << " ns\n"
      << "what,loops,tasks,serial_ms,threads_1_ms,threads_2_ms,threads_4_ms,threads_8_ms,threads_16_ms,unlimited_ms\n";
  const auto n = static_cast<double>(stretch.measured);
  for (const auto& [what, prediction] : predictions) {
    out << what << ',' << static_cast<double>(prediction.loops) / n << ',' << static_cast<double>(prediction.tasks) / n
        << ',' << prediction.serial_ns * 1e-6 / n;
    for (const double ns : prediction.ns) {
      out << ',' << ns * 1e-6 / n;
    }
    out << '\n';
  }
  out << "# measured without recording: 1 thread " << mean_ms(run(sweeps, stretch, 1, false)) << " ms, 2 threads "
      << mean_ms(run(sweeps, stretch, 2, false)) << " ms\n";
}

}  // namespace
}  // namespace rilo::bench

int main(int argc, char** argv) {
  CLI::App app("Time of a sweep on up to 16 threads, computed from its tasks on one (CSV, means a sweep)");
  rilo::bench::Stretch stretch;
  app.add_option("drive", stretch.drive, "sweeps")->required();
  app.add_option("--warm-up", stretch.warm_up, "sweeps before the measured ones")->capture_default_str();
  app.add_option("--sweeps", stretch.measured, "sweeps that are measured")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--runs", stretch.runs, "of each sweep the fastest one counts")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--wake-us", stretch.wake_us, "until a thread that was woken begins; measured unless given")
      ->check(CLI::NonNegativeNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    rilo::bench::study(stretch, std::cout);
  } catch (const std::exception& error) {
    std::cerr << "loops: " << error.what() << '\n';
    return 1;
  }
  return std::cout.good() ? 0 : 1;
}
