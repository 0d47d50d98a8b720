// The map from above.
#pragma once

#include <optional>
#include <vector>

#include "png.hpp"
#include "report/run_report.hpp"

namespace rilo {

/// Picture of the map; x of the odometry frame to the right, y up.
struct BirdsEyeMap {
  IndexedImage image;
  double min_x_m = 0;  ///< left edge
  double max_y_m = 0;  ///< top edge
  double metres_per_pixel = 0;
};

/// Heights above the local ground (m) that of the first and the last colour of the map.
inline constexpr double kMapColourLowM = 0.0;
inline constexpr double kMapColourHighM = 6.0;
/// The colours between them, evenly spaced.
const std::vector<Rgba>& map_colours();

/// Draws `points`, coloured by height above the local ground, brighter where they are denser; the picture covers the
/// trajectory and nearly all points no farther from it than it is long, or 20 m. Empty when no point is finite.
std::optional<BirdsEyeMap> draw_birds_eye(const std::vector<Eigen::Vector3f>& points, const std::vector<SE3>& poses);

}  // namespace rilo
