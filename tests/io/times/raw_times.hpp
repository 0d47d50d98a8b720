// Fields of point times as files have them.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "rilo/io/cloud_reader.hpp"

namespace rilo::test {

inline RawTimes floats(const std::string& field, ScalarType type, std::vector<double> values) {
  if (type == ScalarType::kFloat32) {
    for (double& value : values) value = static_cast<double>(static_cast<float>(value));
  }
  return {field, type, std::move(values), {}};
}
inline RawTimes integers(const std::string& field, ScalarType type, std::vector<std::int64_t> values) {
  return {field, type, {}, std::move(values)};
}

}  // namespace rilo::test
