// The point times of one sweep, as stored, and what can be said about them before their unit is known.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "rilo/io/cloud_reader.hpp"

namespace rilo::detail {

/// A range of the times of the measured points; at first all of them. Refers to what it is made of.
class TimeField {
 public:
  /// `raw` is as long as `points`; those that are not measured, and times that are not finite, take no part.
  TimeField(const RawTimes& raw, const std::filesystem::path& file, const std::vector<Eigen::Vector3f>& points);

  /// Without the ends, 2 % of the times each: a wrong time, or a packet of them, is not in it. All of few times.
  TimeField bulk() const;
  /// The times that can be of one sweep: from the far end of the bulk, 1.25 times the period, or the bulk's span where
  /// that is more. All of them where they span no more.
  TimeField of_one_sweep(double period) const;
  /// The times from `least` to `most`, or all when those beyond are more than the ends of the bulk.
  TimeField between(double least, double most) const;

  bool empty() const { return count_ == 0; }
  bool constant() const { return count_ > 0 && span() == 0; }
  double value(std::size_t i) const { return floating_ ? raw_.floats[i] : static_cast<double>(raw_.integers[i]); }
  /// Exact for integers, however far they are from zero.
  double since_first(std::size_t i) const { return apart(i, first_); }
  double least() const { return value(first_); }
  double most() const { return value(last_); }
  double span() const { return since_first(last_); }
  double farthest() const;
  /// Whether the time is finite and in the range.
  bool holds(std::size_t i) const;
  std::size_t first() const { return first_; }
  std::size_t last() const { return last_; }
  const RawTimes& raw() const { return raw_; }
  const std::filesystem::path& file() const { return file_; }
  std::string name() const { return raw_.field + " (" + std::string(to_string(raw_.type)) + ")"; }

  /// @throws IoError with all of the times.
  [[noreturn]] void reject(const std::string& why, const std::string& remedy) const;

 private:
  bool less(std::size_t a, std::size_t b) const {
    return floating_ ? raw_.floats[a] < raw_.floats[b] : raw_.integers[a] < raw_.integers[b];
  }
  double apart(std::size_t a, std::size_t b) const;
  bool takes_part(std::size_t i) const;
  template <typename Inside>
  void narrow(Inside&& inside);

  const RawTimes& raw_;
  const std::filesystem::path& file_;
  const std::vector<Eigen::Vector3f>& points_;
  bool floating_;
  std::size_t count_ = 0;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
  std::size_t whole_first_ = 0;
  std::size_t whole_last_ = 0;
};

/// Appends first and last of the bulk, for looking at many sweeps without keeping them; nothing where nothing is timed.
/// Returns whether they differ.
bool add_time_ends(const RawTimes& raw, const std::vector<Eigen::Vector3f>& points, std::vector<RawTimes>& ends);

}  // namespace rilo::detail
