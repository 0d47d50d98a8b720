// What a notebook shows of our objects.
#pragma once

#include <clocale>
#include <cstdio>
#include <pybind11/pybind11.h>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace rilo::python {

/// Numbers of this thread with a decimal point, whatever the process has set, while it lives.
class PointLocale {
 public:
  PointLocale() : before_(uselocale(point())) {}
  ~PointLocale() { uselocale(before_); }
  PointLocale(const PointLocale&) = delete;
  PointLocale& operator=(const PointLocale&) = delete;

 private:
  static locale_t point() {
    static const locale_t kPoint = newlocale(LC_NUMERIC_MASK, "C", duplocale(LC_GLOBAL_LOCALE));
    return kPoint;
  }

  locale_t before_;
};

/// One printf of a few numbers.
template <typename... Values>
std::string text_of(const char* format, Values... values) {
  const PointLocale locale;
  std::string text(static_cast<std::size_t>(std::snprintf(nullptr, 0, format, values...)) + 1, '\0');
  text.resize(static_cast<std::size_t>(std::snprintf(text.data(), text.size(), format, values...)));
  return text;
}

inline std::string position_text(const Eigen::Vector3d& p) {
  return text_of("(%.3f, %.3f, %.3f) m", p.x(), p.y(), p.z());
}

/// Any bytes as text, what is not UTF-8 (names of files) replaced.
pybind11::str python_text(const std::string& bytes);

using HtmlRows = std::vector<std::pair<std::string, std::string>>;

/// A table of two columns, its texts escaped.
pybind11::str html_table(const std::string& title, const HtmlRows& rows);

}  // namespace rilo::python
