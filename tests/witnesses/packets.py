"""Packets of sensors, and captures of them."""

import json
import struct
from pathlib import Path

BEGIN_NS = 1_700_000_123_000_000_000


def capture(path: Path, port: int, packets: list[tuple[int, bytes]]) -> Path:
    """A pcap with nanoseconds: one Ethernet frame per packet of (ns, payload)."""
    with path.open("wb") as file:
        file.write(struct.pack("<IHHiIII", 0xA1B23C4D, 2, 4, 0, 0, 65535, 1))
        for stamp_ns, payload in packets:
            udp = struct.pack(">HHHH", 2000, port, len(payload) + 8, 0) + payload
            ip = struct.pack(">BBHHHBBH4s4s", 0x45, 0, len(udp) + 20, 1, 0, 64, 17, 0, b"\n\0\0\1", b"\n\0\0\2") + udp
            frame = b"\x11" * 12 + b"\x08\x00" + ip
            file.write(struct.pack("<IIII", stamp_ns // 10**9, stamp_ns % 10**9, len(frame), len(frame)) + frame)
    return path


def vlp16(count: int) -> list[tuple[int, bytes]]:
    """Packets of 12 blocks of 1 degree, 30 per revolution of 0.1 s."""
    packets = []
    for number in range(count):
        blocks = b""
        for block in range(12):
            azimuth = (9000 + number * 1200 + block * 100) % 36000
            shots = b"".join(struct.pack("<HB", 3000 + 17 * k + number, k) for k in range(32))
            blocks += struct.pack("<HH", 0xEEFF, azimuth) + shots
        packets.append((BEGIN_NS + number * 3_333_000, blocks + struct.pack("<IBB", 100 + number * 3333, 0x37, 0x22)))
    return packets


OUSTER_METADATA = json.dumps(
    {
        "lidar_mode": "1024x10",
        "prod_line": "OS-1-4",
        "beam_altitude_angles": [10, 0, -10, -20],
        "beam_azimuth_angles": [0, 1, 0, -1],
        "lidar_origin_to_beam_origin_mm": 15.0,
        "data_format": {
            "columns_per_frame": 1024,
            "columns_per_packet": 16,
            "pixels_per_column": 4,
            "udp_profile_lidar": "RNG19_RFL8_SIG16_NIR16",
        },
    }
)


def ouster(count: int) -> list[tuple[int, bytes]]:
    """Packets of 16 of a frame's 1024 columns."""
    packets = []
    for number in range(count):
        ns = 5_000_000 + number * 1_562_500
        packet = struct.pack("<HH28x", 1, 7 + number // 64)
        for i in range(16):
            packet += struct.pack("<QHH", ns + i * 97_656, number % 64 * 16 + i, 1)
            packet += b"".join(struct.pack("<IB7x", 4000 + 500 * k + number, 20 + k) for k in range(4))
        packets.append((BEGIN_NS + ns, packet + bytes(32)))
    return packets
