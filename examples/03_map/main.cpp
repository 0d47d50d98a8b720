// The map of a whole run: map DATA MAP.ply (or .pcd)
#include <cstdio>
#include <exception>

#include "rilo/io/map_writer.hpp"
#include "rilo/session/session.hpp"
#include "rilo/session/session_observer.hpp"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: map DATA MAP.ply\n", stderr);
    return 2;
  }
  try {
    rilo::SessionOptions options;
    options.keep_intensities = true;
    rilo::Session session([&] { return rilo::open_scan_source(argv[1]); }, options);
    rilo::MapObserver map(0.2);  // m: one point per voxel of this edge
    session.add(map);
    const rilo::SessionResult run = session.run();
    if (run.failure) std::rethrow_exception(run.failure);

    const rilo::MapCloud cloud = map.cloud(true);  // with normals
    rilo::write_map(argv[2], cloud);
    std::printf("%zu points of %zu sweeps in %s\n", cloud.points.size(), run.results.size(), argv[2]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "map: %s\n", error.what());
    return 1;
  }
}
