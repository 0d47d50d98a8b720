"""Odometry over any data that rilo reads, poses into a file in KITTI's form: python write_poses.py DATA FILE"""

import sys

import rilo

odometry = rilo.Odometry()
for sweep in rilo.open(sys.argv[1]):
    odometry.register(sweep.points, sweep.times_s, sweep.stamp_ns, sweep.rings)
rilo.write_poses(sys.argv[2], odometry.trajectory, format="kitti")
print(odometry)
