// How time and memory grow with what the odometry is given.
#pragma once

#include <cstddef>
#include <ostream>

namespace rilo::bench {

/// Size of a study.
struct StudySize {
  std::size_t warm_up = 60;    ///< sweeps before the measurement begins
  std::size_t measured = 150;  ///< sweeps that are measured
};

/// Points of a sweep: 16384, doubled up to 262144.
void study_points(const StudySize& size, std::ostream& out);
/// map.radius_m: 15, doubled up to 240, after a drive that has filled it.
void study_map(const StudySize& size, std::ostream& out);
/// 1 and 2 threads.
void study_threads(const StudySize& size, std::ostream& out);
/// Speed of the vehicle, m/s.
void study_speed(const StudySize& size, std::ostream& out);
/// Memory over `size.measured` sweeps: a drive from where the vehicle stands to where it stands again, driven forward
/// and backward. The value of a line is the number of sweeps so far.
void study_memory(const StudySize& size, std::ostream& out);

}  // namespace rilo::bench
