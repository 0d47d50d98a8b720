// From the first packets of a recording to the sensor that they are from.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "io/packets/packet_decoder.hpp"
#include "io/packets/packet_stream.hpp"
#include "rilo/io/source_options.hpp"

namespace rilo::detail {

/// An Ouster's metadata that lies in the recording itself.
struct RecordedMetadata {
  std::string text;  ///< empty: none
  std::string part;  ///< "topic /ouster/metadata", for messages
};

/// Looks at the first packets of `stream`, which is used up by it. An Ouster's metadata is, in this order: options'
/// sensor_file, `recorded`, the .json beside `path` of the same name, the only metadata beside it (the only ones of the
/// sensor whose serial number the packets have), the only one there whose name begins with the recording's or the
/// longest one that the recording's begins with.
/// @throws IoError with the kinds of packets found when the sensor is unknown, with the names of the .json files beside
/// `path` when none can be chosen, or with the serial numbers when the metadata are another sensor's.
std::unique_ptr<PacketDecoder> find_decoder(PacketStream& stream, const std::filesystem::path& path,
                                            const SourceOptions& options, const RecordedMetadata& recorded = {});

}  // namespace rilo::detail
