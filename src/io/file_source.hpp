// Sweeps from files, one file each.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "io/scan_listing.hpp"
#include "io/sweep_timing.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

class FileSource final : public ScanSource {
 public:
  FileSource(ScanListing listing, const SourceOptions& options);

  std::optional<Sweep> next() override;
  std::size_t skip(std::size_t count) override;
  std::optional<std::size_t> size() const override { return listing_.files.size(); }
  std::size_t current_index() const override { return current_; }
  std::string current_name() const override;
  SourceInfo info() const override;

 private:
  Sweep load(std::size_t index);
  RawCloud read_cloud(const std::filesystem::path& file) const;
  void set_times(std::size_t index, std::optional<RawTimes> times, Sweep& sweep);

  ScanListing listing_;
  SourceOptions options_;
  SweepTiming timing_;
  std::size_t cursor_ = 0;   // of the next sweep
  std::size_t current_ = 0;  // of the last one
};

}  // namespace rilo::detail
