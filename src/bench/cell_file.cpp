#include "bench/cell_file.hpp"

#include <fstream>
#include <system_error>

#include "console/text.hpp"
#include "io/atomic_file.hpp"
#include "results/metrics_json.hpp"
#include "results/run_outputs.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {

namespace fs = std::filesystem;

namespace {

nlohmann::json packed_kitti(const KittiError& error) {
  nlohmann::json segments = nlohmann::json::array();
  for (const KittiSegment& s : error.segments) {
    segments.push_back({s.first, s.last, s.length_m, s.t_err, s.r_err_rad_per_m});
  }
  return {{"short_path", error.short_path}, {"segments", segments}};
}

KittiError unpacked_kitti(const nlohmann::json& json) {
  KittiError error;
  error.short_path = json.at("short_path");
  for (const auto& s : json.at("segments")) error.segments.push_back({s.at(0), s.at(1), s.at(2), s.at(3), s.at(4)});
  return error;
}

}  // namespace

nlohmann::json metrics_json(const BenchCell& cell) {
  const bool run = !cell.peer && !cell.failed();
  return to_json(cell.metrics, run ? MetricKeys::kAll : MetricKeys::kSparse);
}

nlohmann::json packed(const BenchCell& cell) {
  nlohmann::json json = {{"sequence", cell.sequence},
                         {"configuration", cell.configuration},
                         {"peer", cell.peer},
                         {"settings", cell.settings},
                         {"metrics", metrics_json(cell)},
                         {"error", cell.error},
                         {"error_code", static_cast<int>(cell.error_code)}};
  if (!cell.group.empty()) json["group"] = cell.group;
  if (cell.kitti) json["kitti"] = packed_kitti(*cell.kitti);
  return json;
}

BenchCell unpacked(const nlohmann::json& json) {
  BenchCell cell;
  cell.sequence = json.at("sequence");
  cell.configuration = json.at("configuration");
  cell.peer = json.at("peer");
  cell.settings = json.at("settings");
  cell.metrics = metrics_of(json.at("metrics"), "cell of a benchmark");
  cell.error = json.at("error");
  cell.error_code = static_cast<ExitCode>(json.at("error_code").get<int>());
  cell.group = json.value("group", "");
  if (json.contains("kitti")) cell.kitti = unpacked_kitti(json["kitti"]);
  return cell;
}

CellFolder::CellFolder(const fs::path& results, bool kept) : folder_(results / kCells), kept_(kept) {
  create_folder(folder_);
}

std::optional<CellRecord> CellFolder::read(const BenchJob& job) const {
  std::ifstream stream(file(job), std::ios::binary);
  if (!stream) return std::nullopt;
  try {
    const nlohmann::json json = nlohmann::json::parse(stream);
    if (json.at("rilo_cell") != 1 || json.at("key") != job.key) return std::nullopt;
    CellRecord record{{}, json.at("attempts"), json.at("log"), json.at("host")};
    for (const auto& cell : json.at("cells")) record.cells.push_back(unpacked(cell));
    if (record.cells.empty()) return std::nullopt;
    return record;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  } catch (const IoError&) {
    return std::nullopt;
  }
}

void CellFolder::write(const BenchJob& job, const CellRecord& record) const {
  nlohmann::json json = {
      {"rilo_cell", 1},    {"key", job.key},      {"description", job.description},  {"attempts", record.attempts},
      {"log", record.log}, {"host", record.host}, {"cells", nlohmann::json::array()}};
  for (const BenchCell& cell : record.cells) json["cells"].push_back(packed(cell));
  write_atomically(file(job), json_text(json));
}

void CellFolder::remove(const BenchJob& job) const {
  std::error_code ignored;
  fs::remove(file(job), ignored);
}

}  // namespace rilo
