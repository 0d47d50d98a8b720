#include "bench_jobs.hpp"

#include <algorithm>
#include <iostream>
#include <iterator>
#include <set>
#include <utility>

#include "bench/paper.hpp"
#include "bench/peer_figures.hpp"
#include "config/bench_plan.hpp"
#include "console/text.hpp"
#include "io/file_bytes.hpp"
#include "rilo/config/config_file.hpp"

namespace rilo::cli {

namespace {

// Data of the command line in the place of the plan's.
std::vector<BenchSequence> sequences_of(const BenchFlags& flags) {
  std::vector<BenchSequence> sequences;
  std::set<std::string> names;
  for (const std::string& path : flags.data) {
    BenchSequence sequence;
    sequence.path = path;
    sequence.name = valid_utf8(last_name(path));
    if (!names.insert(sequence.name).second) sequence.name = valid_utf8(path);
    sequences.push_back(sequence);
  }
  return sequences;
}

// A missing one alone fails as a cell, or is left out where the plan says so; a wrong --root is an error of the whole.
void look_for_sequences(const BenchFlags& flags, BenchPlan& plan) {
  std::string missing;
  std::vector<BenchSequence> there;
  for (const BenchSequence& sequence : plan.sequences) {
    if (detail::path_exists(sequence.path)) {
      there.push_back(sequence);
    } else {
      missing += (missing.empty() ? "" : ", ") + sequence.path.string();
    }
  }
  if (there.empty()) {
    throw RunError(RunErrorKind::kBadData,
                   flags.plan + ": none of its sequences is there: " + missing +
                       (flags.data.empty() ? "; name the folder that they lie in with --root" : "; see --data"));
  }
  if (!plan.skip_missing || !flags.data.empty()) return;
  if (!missing.empty() && !flags.order.run.quiet) std::cerr << "skipped, as they do not exist: " << missing << '\n';
  plan.sequences = std::move(there);
}

// Those of the plan itself were checked with it.
void check_peer_name(const BenchPlan& plan, const std::string& name, const std::string& origin) {
  if (!has_configuration(plan, name)) return;
  throw RunError(RunErrorKind::kUsage,
                 origin + ": \"" + name + "\" is both a configuration and a peer; expected names that differ");
}

// What to make of figures of whole drives where parts are run. A part that the plan names may be what they are of.
std::string doubtful_figures(const BenchFlags& flags, const BenchPlan& plan) {
  if (flags.order.run.count > 0) return "with --count its times alone are used";
  std::string parts;
  for (const BenchSequence& sequence : plan.sequences) {
    const bool named = std::any_of(flags.order.peer_figures.begin(), flags.order.peer_figures.end(),
                                   [&](const BenchCell& figures) { return figures.sequence == sequence.name; });
    if (named && (sequence.start > 0 || sequence.count > 0)) parts += (parts.empty() ? "" : ", ") + sequence.name;
  }
  return parts.empty() ? "" : "a part alone is run of " + parts;
}

std::vector<BenchPeer> peers_of(const BenchFlags& flags, const BenchPlan& plan) {
  std::vector<BenchPeer> peers;
  for (const std::string& text : flags.peers) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
      throw RunError(RunErrorKind::kUsage,
                     "--peer " + text + ": expected NAME=FILE, {sequence} in it for a sequence's name");
    }
    peers.push_back({text.substr(0, equals), text.substr(equals + 1)});
    check_peer_name(plan, peers.back().name, "--peer " + text);
  }
  return peers;
}

// Those of the command line go before those of the plan.
void add_peers(const BenchFlags& flags, BenchPlan& plan) {
  std::vector<BenchPeer> peers = peers_of(flags, plan);
  const auto named = [&](const std::string& name) {
    return std::any_of(peers.begin(), peers.end(), [&](const BenchPeer& peer) { return peer.name == name; });
  };
  std::copy_if(plan.peers.begin(), plan.peers.end(), std::back_inserter(peers),
               [&](const BenchPeer& peer) { return !named(peer.name); });
  plan.peers = std::move(peers);
  give_peers(plan);
}

void take_peer_figures(BenchFlags& flags, BenchPlan& plan) {
  if (!flags.peer_figures.empty()) plan.peer_figures = flags.peer_figures;
  if (plan.peer_figures.empty()) return;
  flags.order.peer_figures = read_peer_figures(plan.peer_figures);
  for (const BenchCell& cell : flags.order.peer_figures) {
    check_peer_name(plan, cell.configuration, plan.peer_figures.string());
  }
  const std::string doubt = doubtful_figures(flags, plan);
  if (doubt.empty() || flags.order.run.quiet) return;
  std::cerr << "rilo: warning: " << plan.peer_figures.string() << ": its figures are of whole drives; " << doubt
            << '\n';
}

// Of the command line, for KITTI and M2DGR.
BenchConfiguration configuration_of(const BenchFlags& flags) {
  BenchConfiguration result;
  result.name = "rilo";
  result.settings = flags.settings;
  if (!flags.config_file.empty()) {
    result.settings.insert(result.settings.begin(), std::string(kConfigWord) + last_name(flags.config_file));
  }
  result.config = load_config(flags.config_file, flags.settings);
  return result;
}

}  // namespace

std::vector<BenchJob> plan_jobs(BenchFlags& flags) {
  BenchPlan plan = load_bench_plan(flags.plan, flags.root);
  if (!flags.data.empty()) plan.sequences = sequences_of(flags);
  if (plan.sequences.empty()) {
    throw RunError(RunErrorKind::kUsage,
                   flags.plan + ": no sequences: in it; expected them there or folders after --data");
  }
  look_for_sequences(flags, plan);
  add_peers(flags, plan);
  take_peer_figures(flags, plan);
  if (flags.repeats) plan.repeats = *flags.repeats;
  flags.order.tables = plan.tables;
  return jobs_of(plan);
}

std::vector<BenchJob> paper_jobs(BenchFlags& flags, PaperTables tables) {
  flags.order.tables = tables;
  const BenchConfiguration configuration = configuration_of(flags);
  const auto jobs =
      tables == PaperTables::kKitti ? kitti_jobs(flags.root, configuration) : m2dgr_jobs(flags.root, configuration);
  return repeated(jobs, flags.repeats.value_or(1));
}

}  // namespace rilo::cli
