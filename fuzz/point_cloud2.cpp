// PointCloud2 in both encodings, and the decision what its times mean. The first byte chooses.
#include "rilo/io/point_cloud2.hpp"

#include "harness.hpp"
#include "rilo/io/point_times.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const unsigned choice = data[0];
  const auto encoding = (choice & 1U) != 0 ? rilo::MessageEncoding::kCdr : rilo::MessageEncoding::kRos1;
  rilo::PointTimeHints hints;
  if ((choice & 2U) != 0) hints.period_s = 0.1;
  hints.unit = static_cast<rilo::PointTimeUnit>((choice >> 2U) % 6);
  hints.reference = static_cast<rilo::PointTimeReference>((choice >> 5U) % 3);
  rilo::PointTimeDecoder decoder(hints);
  for (int again = 0; again < 2; ++again) {
    rilo::fuzz::only_io_errors([&] {
      const auto message = rilo::parse_point_cloud2(rilo::fuzz::bytes_of(data + 1, size - 1), encoding, "fuzz");
      rilo::RawCloud cloud = rilo::columns_of(message, "", "fuzz");
      if (!cloud.times) return;
      rilo::Sweep sweep;
      sweep.stamp_ns = message.stamp_ns;
      sweep.points = std::move(cloud.points);
      decoder.decode(*cloud.times, "fuzz", sweep);
      if (sweep.times_s.size() != sweep.points.size()) std::abort();
    });
  }
  return 0;
}
