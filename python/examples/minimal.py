"""Odometry over any data that rilo reads: python minimal.py DATA"""

import sys

import rilo

odometry = rilo.Odometry()
for sweep in rilo.open(sys.argv[1]):
    result = odometry.register(sweep.points, sweep.times_s, sweep.stamp_ns, sweep.rings)
    x, y, z = result.pose[:3, 3]
    print(f"{result.stamp_ns} {result.status} {x:.3f} {y:.3f} {z:.3f}")
print(f"{len(odometry.local_map())} points in the local map")
