// Runs to write pages of, and what every page must hold to.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "report/html_report.hpp"

namespace rilo::test {

/// A drive of `n` sweeps along x, estimated `scale` times too long; sweep i took 10 + i / 10 ms.
RunReport drive(std::size_t n, double scale = 1.01);

/// The page of that run alone.
std::string page(const RunReport& run);

/// The JSON blocks in the order of the page.
std::vector<nlohmann::json> data_of(const std::string& html);

/// One whole document: every element closed in order, no request to anywhere, no number that is none.
void expect_sound(const std::string& html);

}  // namespace rilo::test
