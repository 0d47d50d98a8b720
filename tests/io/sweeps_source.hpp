// A source of sweeps in memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::test {

class SweepsSource : public ScanSource {
 public:
  /// Cannot read the sweep `fails_at`.
  explicit SweepsSource(std::vector<Sweep> sweeps, double period_s = 0.1, std::size_t fails_at = SIZE_MAX)
      : sweeps_(std::move(sweeps)), fails_at_(fails_at) {
    info_.period_s = period_s;
  }

  std::optional<Sweep> next() override {
    if (at_ == fails_at_) throw IoError({current_name(), "", "noise", "a sweep", ""});
    if (at_ == sweeps_.size()) return std::nullopt;
    return sweeps_[at_++];
  }
  std::size_t skip(std::size_t count) override {
    const std::size_t skipped = std::min(count, sweeps_.size() - at_);
    at_ += skipped;
    return skipped;
  }
  std::optional<std::size_t> size() const override { return sweeps_.size(); }
  std::size_t current_index() const override { return at_ - 1; }
  std::string current_name() const override { return "sweep " + std::to_string(at_ - 1); }
  SourceInfo info() const override { return info_; }

 private:
  std::vector<Sweep> sweeps_;
  SourceInfo info_;
  std::size_t fails_at_;
  std::size_t at_ = 0;
};

}  // namespace rilo::test
