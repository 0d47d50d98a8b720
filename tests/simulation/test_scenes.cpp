#include "simulation/test_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "simulation/counter_random.hpp"

namespace rilo {
namespace {

// A rectangle centre + a * u + b * v with |u|, |v| <= 1; the half edges a, b are at right angles.
struct Rectangle {
  Eigen::Vector3d centre, a, b;
};

void sample(const Rectangle& r, std::uint64_t index, const SceneSampling& sampling,
            std::vector<Eigen::Vector3f>& cloud) {
  if (!(sampling.spacing_m > 0)) throw std::invalid_argument("SceneSampling::spacing_m must be above 0 m");
  const SE3 T_sensor_world = sampling.T_world_sensor.inverse();
  const Eigen::Vector3d normal = r.a.cross(r.b).normalized();
  const auto cells = [&](const Eigen::Vector3d& half) {
    return static_cast<std::size_t>(std::max(1.0, std::round(2 * half.norm() / sampling.spacing_m)));
  };
  const std::size_t rows = cells(r.a);
  const std::size_t columns = cells(r.b);
  simulation::RandomStream random(sampling.seed, 0x5ce0e, index);
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      const double u = -1 + 2 * (static_cast<double>(i) + random.uniform(0, 1)) / static_cast<double>(rows);
      const double v = -1 + 2 * (static_cast<double>(j) + random.uniform(0, 1)) / static_cast<double>(columns);
      const double off = sampling.noise_m * random.normal();
      const Eigen::Vector3d p = r.centre + u * r.a + v * r.b + off * normal;
      cloud.push_back((T_sensor_world * p).cast<float>());
    }
  }
}

std::vector<Eigen::Vector3f> sample_all(const std::vector<Rectangle>& rectangles, const SceneSampling& sampling) {
  std::vector<Eigen::Vector3f> cloud;
  for (std::size_t i = 0; i < rectangles.size(); ++i) sample(rectangles[i], i, sampling, cloud);
  return cloud;
}

Eigen::Vector3d x_axis(double length) { return {length, 0, 0}; }
Eigen::Vector3d y_axis(double length) { return {0, length, 0}; }
Eigen::Vector3d z_axis(double length) { return {0, 0, length}; }

}  // namespace

std::vector<Eigen::Vector3f> make_box_room(const Eigen::Vector3d& size_m, const SceneSampling& sampling) {
  const Eigen::Vector3d h = 0.5 * size_m;
  std::vector<Rectangle> faces;
  for (const double side : {-1.0, 1.0}) {
    faces.push_back({x_axis(side * h.x()), y_axis(h.y()), z_axis(h.z())});
    faces.push_back({y_axis(side * h.y()), x_axis(h.x()), z_axis(h.z())});
    faces.push_back({z_axis(side * h.z()), x_axis(h.x()), y_axis(h.y())});
  }
  return sample_all(faces, sampling);
}

std::vector<Eigen::Vector3f> make_corridor(double length_m, double width_m, double height_m,
                                           const SceneSampling& sampling) {
  const double middle_m = 0.5 * height_m - 1;
  const Eigen::Vector3d along = x_axis(0.5 * length_m);
  return sample_all({{z_axis(-1), along, y_axis(0.5 * width_m)},
                     {{0, -0.5 * width_m, middle_m}, along, z_axis(0.5 * height_m)},
                     {{0, 0.5 * width_m, middle_m}, along, z_axis(0.5 * height_m)}},
                    sampling);
}

std::vector<Eigen::Vector3f> make_ground_plane(double side_m, const SceneSampling& sampling) {
  return sample_all({{z_axis(-1), x_axis(0.5 * side_m), y_axis(0.5 * side_m)}}, sampling);
}

std::vector<Eigen::Vector3f> make_two_walls(double length_m, double width_m, double height_m,
                                            const SceneSampling& sampling) {
  const Eigen::Vector3d along = x_axis(0.5 * length_m);
  const Eigen::Vector3d up = z_axis(0.5 * height_m);
  return sample_all({{y_axis(-0.5 * width_m), along, up}, {y_axis(0.5 * width_m), along, up}}, sampling);
}

}  // namespace rilo
