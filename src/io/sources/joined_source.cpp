// Parts that make up a sweep, joined to one.
#include <deque>
#include <exception>
#include <utility>

#include <fmt/format.h>

#include "io/sources/parts_of_sweep.hpp"
#include "io/sources/source_wrappers.hpp"
#include "io/stamp_difference.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

template <typename Value>
void append_column(std::vector<Value>& to, std::size_t points, std::vector<Value>& from, std::size_t from_points) {
  if (to.size() != points || from.size() != from_points) return to.clear();
  to.insert(to.end(), from.begin(), from.end());
}

/// Times that count from another stamp, `offset_s` earlier. Points without times are all at their stamp.
std::vector<float> times_since(const Sweep& part, double offset_s) {
  if (part.times_s.empty()) return std::vector<float>(part.points.size(), static_cast<float>(offset_s));
  std::vector<float> times = part.times_s;
  for (float& t : times) t = static_cast<float>(offset_s + static_cast<double>(t));
  return times;
}

class JoinedSource final : public WrappedSource {
 public:
  JoinedSource(std::unique_ptr<ScanSource> inner, std::size_t parts)
      : WrappedSource(std::move(inner)), found_out_(parts == 0) {
    const SourceInfo info = inner_->info();
    part_s_ = info.period_s;
    timed_ = info.has_point_times;
    parts_ = found_out_ ? find_parts() : parts;
  }

  std::optional<Sweep> next() override {
    Part first = take();
    index_ = first.index;
    name_ = std::move(first.name);
    if (first.error) std::rethrow_exception(first.error);
    if (!first.sweep) return std::nullopt;
    Sweep joined = std::move(*first.sweep);
    if (parts_ > 1) joined.times_s = times_since(joined, 0);
    for (std::size_t i = 1; i < parts_ && next_belongs_to(joined); ++i) append(*take().sweep, joined);
    return joined;
  }

  std::size_t skip(std::size_t count) override {
    std::size_t parts = 0;
    for (; parts < count * parts_ && !waiting_.empty(); ++parts) waiting_.pop_front();
    if (parts < count * parts_) parts += inner_->skip(count * parts_ - parts);
    return in_sweeps(parts);
  }

  std::optional<std::size_t> size() const override {
    const std::optional<std::size_t> parts = inner_->size();
    return parts ? std::optional(in_sweeps(*parts)) : std::nullopt;
  }
  std::size_t current_index() const override { return index_; }
  std::string current_name() const override { return name_; }

  SourceInfo info() const override {
    SourceInfo info = inner_->info();
    info.parts = parts_;
    if (parts_ == 1) return info;
    info.period_s *= static_cast<double>(parts_);
    if (info.sweeps) info.sweeps = in_sweeps(*info.sweeps);
    if (!timed_) info.point_times = "the stamps of the parts of a sweep";
    info.has_point_times = true;
    if (found_out_) {
      info.warnings.push_back(fmt::format(
          "the data come every {:.3g} s and hold parts of sweeps: {} are joined to one (--parts 1 does not, --parts N "
          "joins another number)",
          part_s_, parts_));
    }
    return info;
  }

 private:
  // One outcome of the inner next().
  struct Part {
    std::optional<Sweep> sweep;  // empty with no error: the end
    std::exception_ptr error;
    std::size_t index = 0;
    std::string name;
  };

  Part read() {
    Part part;
    try {
      part.sweep = inner_->next();
    } catch (const IoError&) {
      part.error = std::current_exception();
    }
    part.index = inner_->current_index();
    part.name = inner_->current_name();
    return part;
  }

  Part take() {
    if (waiting_.empty()) return read();
    Part part = std::move(waiting_.front());
    waiting_.pop_front();
    return part;
  }

  std::size_t find_parts() {
    PartsOfSweep found(part_s_);
    while (!found.parts()) {
      waiting_.push_back(read());
      const Part& part = waiting_.back();
      if (part.sweep) found.add(*part.sweep);
      if (!part.sweep && !part.error) return 1;
    }
    return *found.parts();
  }

  // Not across a gap, nor one that cannot be read.
  bool next_belongs_to(const Sweep& joined) {
    if (waiting_.empty()) waiting_.push_back(read());
    const Part& part = waiting_.front();
    if (!part.sweep) return false;
    const double since_s = seconds_between(joined.stamp_ns, part.sweep->stamp_ns);
    return since_s >= 0 && since_s < (static_cast<double>(parts_) - 0.5) * part_s_;
  }

  static void append(Sweep part, Sweep& joined) {
    const std::size_t points = joined.points.size();
    const std::vector<float> times = times_since(part, seconds_between(joined.stamp_ns, part.stamp_ns));
    append_column(joined.intensities, points, part.intensities, part.points.size());
    append_column(joined.rings, points, part.rings, part.points.size());
    joined.times_s.insert(joined.times_s.end(), times.begin(), times.end());
    joined.points.insert(joined.points.end(), part.points.begin(), part.points.end());
  }

  std::size_t in_sweeps(std::size_t parts) const { return (parts + parts_ - 1) / parts_; }

  bool found_out_;
  std::size_t parts_ = 1;
  double part_s_ = 0;
  bool timed_ = false;
  std::deque<Part> waiting_;
  std::size_t index_ = 0;
  std::string name_;
};

}  // namespace

std::unique_ptr<ScanSource> with_joined_parts(std::unique_ptr<ScanSource> inner, std::size_t parts) {
  const SourceInfo info = inner->info();
  const bool whole = info.kind == "packets" || PartsOfSweep(info.period_s).parts();  // packets make whole turns
  if (parts == 1 || (parts == 0 && whole)) return inner;
  return std::make_unique<JoinedSource>(std::move(inner), parts);
}

}  // namespace rilo::detail
