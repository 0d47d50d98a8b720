// A whole recording or folder in one call, with the poses of `rilo run`: recording DATA POSES.tum
#include <cstdio>
#include <exception>

#include "rilo/io/trajectory_files.hpp"
#include "rilo/session/session.hpp"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: recording DATA POSES.tum\n", stderr);
    return 2;
  }
  try {
    rilo::SourceOptions data;  // as the options of `rilo run`: topic, point times, rate, ...
    // data.topic = "/velodyne_points";
    const rilo::SessionResult run = rilo::run_recording(argv[1], rilo::SessionOptions{}, data);
    rilo::write_tum(argv[2], run.trajectory());
    std::printf("%zu poses from %s (%s, point times: %s) in %.1f s\n", run.results.size(), argv[1],
                run.source.format.c_str(), run.source.point_times.c_str(), run.wall_s);
    return 0;
  } catch (const std::exception& error) {  // IoError names the file, what was found and what was expected
    std::fprintf(stderr, "recording: %s\n", error.what());
    return 1;
  }
}
