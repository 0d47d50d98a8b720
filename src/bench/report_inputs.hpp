// What rilo report is given: folders and files, with the names they go by.
#pragma once

#include <filesystem>
#include <string>

namespace rilo {

enum class ReportInputKind { kRun, kBench, kPoses };

struct ReportInput {
  ReportInputKind kind = ReportInputKind::kRun;
  std::string sequence;  ///< empty: as the results say, or the only one there is
  std::string name;      ///< empty: from the path
  std::filesystem::path path;
  bool named = false;  ///< by NAME=
};

/// `[[SEQUENCE/]NAME=]PATH`. A word that is an existing path is a path, whatever it contains.
/// @throws IoError when the path is neither results nor poses, with what lies there and what was expected.
ReportInput parse_report_input(const std::string& word);

/// `[SEQUENCE=]PATH` of true poses.
struct ReportTruth {
  std::string sequence;  ///< empty: of every sequence
  std::filesystem::path path;
};
/// @throws IoError when there is nothing at the path.
ReportTruth parse_report_truth(const std::string& word);

}  // namespace rilo
