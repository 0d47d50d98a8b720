#include "birds_eye.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace rilo {

namespace {

constexpr int kHeightLevels = 50;
constexpr int kDensityLevels = 5;
constexpr double kMaxPixels = 1500.0;  // longer side
constexpr double kMinMetresPerPixel = 0.05;
constexpr double kLeastAroundM = 20.0;  // shown around the trajectory
constexpr double kGroundCellM = 5.0;
constexpr double kSteepestSlope = 0.3;
constexpr std::size_t kWitnesses = 3;  // neighbours that a median needs
constexpr float kNoGround = std::numeric_limits<float>::max();

/// Regular cells over the area of the picture.
struct Grid {
  double min_x = 0;
  double min_y = 0;
  double cell_m = 1;
  int columns = 0;
  int rows = 0;

  /// Index of the cell, or −1 outside.
  std::ptrdiff_t cell_of(const Eigen::Vector3f& p) const {
    const double column = std::floor((static_cast<double>(p.x()) - min_x) / cell_m);
    const double row = std::floor((static_cast<double>(p.y()) - min_y) / cell_m);
    if (!(column >= 0 && row >= 0 && column < columns && row < rows)) return -1;
    return static_cast<std::ptrdiff_t>(row) * columns + static_cast<std::ptrdiff_t>(column);
  }
  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

struct Box {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector2d high = Eigen::Vector2d::Constant(std::numeric_limits<double>::lowest());

  void include(const Eigen::Vector2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

float quantile(std::vector<float>& values, double q) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

/// Area of the trajectory and of all but the farthest points: a few stray returns must not shrink the picture, nor what
/// is seen through the windows of a room.
Box area_of(const std::vector<Eigen::Vector3f>& points, const std::vector<SE3>& poses) {
  std::vector<float> x;
  std::vector<float> y;
  for (const Eigen::Vector3f& p : points) {
    x.push_back(p.x());
    y.push_back(p.y());
  }
  Box box;
  for (const double q : {0.004, 0.996}) box.include({quantile(x, q), quantile(y, q)});
  if (!poses.empty()) {
    Box path;
    for (const SE3& T : poses) path.include(T.translation().head<2>());
    const Eigen::Vector2d around =
        Eigen::Vector2d::Constant(std::max(kLeastAroundM, (path.high - path.low).maxCoeff()));
    box.low = box.low.cwiseMax(path.low - around).cwiseMin(path.low);
    box.high = box.high.cwiseMin(path.high + around).cwiseMax(path.high);
  }
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(2.0);
  box.low -= margin;
  box.high += margin;
  return box;
}

Grid grid_over(const Box& box, double cell_m) {
  Grid grid;
  grid.min_x = box.low.x();
  grid.min_y = box.low.y();
  grid.cell_m = cell_m;
  grid.columns = std::max(1, static_cast<int>(std::ceil((box.high.x() - box.low.x()) / cell_m)));
  grid.rows = std::max(1, static_cast<int>(std::ceil((box.high.y() - box.low.y()) / cell_m)));
  return grid;
}

/// Pixels no finer than the points are dense, or the picture falls apart into specks.
double pixel_size(const Box& box, std::size_t points) {
  const Eigen::Vector2d extent = box.high - box.low;
  const double spacing = std::sqrt(extent.x() * extent.y() / static_cast<double>(points));
  return std::max({extent.maxCoeff() / kMaxPixels, kMinMetresPerPixel, 0.35 * spacing});
}

/// Calls `visit` with each neighbour of a cell, the cell itself included.
template <typename Visit>
void for_neighbours(const Grid& grid, std::size_t cell, const Visit& visit) {
  const int row = static_cast<int>(cell) / grid.columns;
  const int column = static_cast<int>(cell) % grid.columns;
  for (int r = std::max(0, row - 1); r <= std::min(grid.rows - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(grid.columns - 1, column + 1); ++c) {
      visit(static_cast<std::size_t>(r * grid.columns + c));
    }
  }
}

/// The lowest tenth of the points of each cell.
std::vector<float> low_heights(const std::vector<Eigen::Vector3f>& points, const Grid& grid) {
  std::vector<std::vector<float>> heights(grid.size());
  for (const Eigen::Vector3f& p : points) {
    const std::ptrdiff_t cell = grid.cell_of(p);
    if (cell >= 0) heights[static_cast<std::size_t>(cell)].push_back(p.z());
  }
  std::vector<float> low(grid.size(), kNoGround);
  for (std::size_t i = 0; i < low.size(); ++i) {
    if (!heights[i].empty()) low[i] = quantile(heights[i], 0.1);
  }
  return low;
}

/// Mirrored returns lie below the ground: where a cell has few points they would pull the ground of all its neighbours
/// down. A cell that lies deeper than a steep slope below the median of its neighbours gets that in its place.
std::vector<float> without_pits(const std::vector<float>& low, const Grid& grid) {
  std::vector<float> result(low);
  std::vector<float> around;
  for (std::size_t i = 0; i < low.size(); ++i) {
    around.clear();
    for_neighbours(grid, i, [&](std::size_t j) {
      if (j != i && low[j] != kNoGround) around.push_back(low[j]);
    });
    if (low[i] == kNoGround || around.size() < kWitnesses) continue;
    const float usual = quantile(around, 0.5);
    if (low[i] < usual - static_cast<float>(kSteepestSlope * grid.cell_m)) result[i] = usual;
  }
  return result;
}

/// Height of the ground in each cell, smoothed downwards over the neighbours so that a cell with a wall or a canopy
/// alone borrows the ground beside it.
std::vector<float> ground_heights(const std::vector<Eigen::Vector3f>& points, const Grid& grid) {
  const std::vector<float> low = without_pits(low_heights(points, grid), grid);
  std::vector<float> ground(low);
  for (std::size_t i = 0; i < low.size(); ++i) {
    for_neighbours(grid, i, [&](std::size_t j) { ground[i] = std::min(ground[i], low[j]); });
  }
  return ground;
}

Rgba mixed(const Rgba& a, const Rgba& b, double s, double brightness) {
  Rgba c{0, 0, 0, 255};
  for (std::size_t i = 0; i < 3; ++i) {
    c[i] = static_cast<std::uint8_t>(std::lround(brightness * (a[i] + s * (b[i] - a[i]))));
  }
  return c;
}

/// Entry 0 is transparent; then kDensityLevels brightnesses of each height.
std::vector<Rgba> palette() {
  const std::vector<Rgba>& stops = map_colours();
  std::vector<Rgba> colours{{0, 0, 0, 0}};
  for (int height = 0; height < kHeightLevels; ++height) {
    const double place = static_cast<double>(height) / (kHeightLevels - 1) * static_cast<double>(stops.size() - 1);
    const auto stop = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    for (int density = 0; density < kDensityLevels; ++density) {
      const double brightness = 0.65 + 0.35 * density / (kDensityLevels - 1);
      colours.push_back(mixed(stops[stop], stops[stop + 1], place - static_cast<double>(stop), brightness));
    }
  }
  return colours;
}

std::uint8_t colour_index(double height_m, int count) {
  const double share = std::clamp((height_m - kMapColourLowM) / (kMapColourHighM - kMapColourLowM), 0.0, 1.0);
  const int level = static_cast<int>(std::lround(share * (kHeightLevels - 1)));
  const int density = std::clamp(static_cast<int>(std::log2(count)), 0, kDensityLevels - 1);
  return static_cast<std::uint8_t>(1 + level * kDensityLevels + density);
}

}  // namespace

const std::vector<Rgba>& map_colours() {
  static const std::vector<Rgba> kColours{{72, 108, 168, 255}, {44, 140, 160, 255}, {70, 185, 130, 255},
                                          {190, 210, 90, 255}, {250, 200, 80, 255}, {245, 140, 70, 255},
                                          {235, 90, 90, 255}};
  return kColours;
}

std::optional<BirdsEyeMap> draw_birds_eye(const std::vector<Eigen::Vector3f>& points, const std::vector<SE3>& poses) {
  std::vector<Eigen::Vector3f> finite;
  std::copy_if(points.begin(), points.end(), std::back_inserter(finite),
               [](const Eigen::Vector3f& p) { return p.allFinite(); });
  if (finite.empty()) return std::nullopt;
  const Box box = area_of(finite, poses);
  const Grid pixels = grid_over(box, pixel_size(box, finite.size()));
  const Grid cells = grid_over(box, std::max(kGroundCellM, 4.0 * pixels.cell_m));
  const std::vector<float> ground = ground_heights(finite, cells);
  std::vector<float> top(pixels.size(), std::numeric_limits<float>::lowest());
  std::vector<int> count(pixels.size(), 0);
  for (const Eigen::Vector3f& p : finite) {
    const std::ptrdiff_t pixel = pixels.cell_of(p);
    const std::ptrdiff_t cell = cells.cell_of(p);
    if (pixel >= 0 && cell >= 0) {
      const auto i = static_cast<std::size_t>(pixel);
      top[i] = std::max(top[i], p.z() - ground[static_cast<std::size_t>(cell)]);
      ++count[i];
    }
  }
  BirdsEyeMap map{{pixels.columns, pixels.rows, palette(), std::vector<std::uint8_t>(pixels.size(), 0)},
                  pixels.min_x,
                  pixels.min_y + pixels.rows * pixels.cell_m,
                  pixels.cell_m};
  for (int row = 0; row < pixels.rows; ++row) {
    for (int column = 0; column < pixels.columns; ++column) {
      const auto from = static_cast<std::size_t>(row * pixels.columns + column);
      const auto to = static_cast<std::size_t>((pixels.rows - 1 - row) * pixels.columns + column);
      map.image.pixels[to] = count[from] == 0 ? std::uint8_t{0} : colour_index(top[from], count[from]);
    }
  }
  return map;
}

}  // namespace rilo
