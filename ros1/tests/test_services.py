"""What can be asked of the node while it runs."""

import numpy as np
import rospy
from geometry_msgs.msg import Pose, PoseWithCovarianceStamped
from nav_msgs.msg import Path
from rilo_ros.srv import SaveMap, SetPose
from std_srvs.srv import Trigger

from driven_node import connected_node, matrix, poses_of, publish, wait_figure
from ros_system import first_of, wait_for


def test_reset_starts_anew_at_the_identity(topics, drive):
    with connected_node(topics):
        publish(topics, drive.sweeps[:5])
        assert rospy.ServiceProxy("/rilo/reset", Trigger)().success
        publish(topics, drive.sweeps[5:8], 8)
        report = wait_figure(topics, "sweeps registered", 8)
    assert report["resets"] == "1" and report["status initialising"] == "2"
    poses = poses_of(topics.odometry.messages)
    assert np.array_equal(poses[5], np.eye(4)) and not np.array_equal(poses[4], np.eye(4))


def test_set_pose_moves_what_follows_and_the_path(topics, drive):
    wanted = Pose()
    wanted.position.x, wanted.position.y, wanted.position.z = 100, -50, 3
    wanted.orientation.z, wanted.orientation.w = np.sin(0.6), np.cos(0.6)
    with connected_node(topics):
        publish(topics, drive.sweeps[:4])
        set_pose = rospy.ServiceProxy("/rilo/set_pose", SetPose)
        assert set_pose(wanted).success
        publish(topics, drive.sweeps[4:6], 6)
        path = first_of("/path", Path)
        refused = set_pose(Pose())  # the quaternion is zero
        assert not refused.success and "length 1" in refused.message
        # As rviz' tool sets it.
        tool = rospy.Publisher("/initialpose", PoseWithCovarianceStamped, queue_size=1)
        wait_for(lambda: tool.get_num_connections() > 0, "the node's subscription to initialpose")
        message = PoseWithCovarianceStamped()
        message.header.frame_id = "odom"
        message.pose.pose.orientation.w = 1
        tool.publish(message)
        wait_for(lambda: abs(first_of("/path", Path).poses[5].pose.position.x) < 1e-9, "the pose of initialpose")
    poses, offline = poses_of(topics.odometry.messages), drive.offline.poses
    np.testing.assert_allclose(poses[:4], offline[:4], rtol=0, atol=1e-9)
    start = matrix(wanted.position, wanted.orientation) @ np.linalg.inv(offline[3])
    np.testing.assert_allclose(poses[4:], start @ offline[4:6], rtol=0, atol=1e-9)
    np.testing.assert_allclose([matrix(p.pose.position, p.pose.orientation) for p in path.poses], start @ offline[:6],
                               rtol=0, atol=1e-9)


def test_the_map_is_saved(topics, drive, tmp_path):
    with connected_node(topics):
        publish(topics, drive.sweeps[:4])
        save_map = rospy.ServiceProxy("/rilo/save_map", SaveMap)
        for name, counted in (("map.ply", "element vertex {}"), ("map.pcd", "POINTS {}")):
            answer = save_map(str(tmp_path / name))
            assert answer.success and answer.points > 1000
            header = (tmp_path / name).read_bytes()[:600].decode("ascii", "replace")
            assert counted.format(answer.points) in header.replace("  ", " ")
        for wrong in (tmp_path / "nowhere" / "map.ply", tmp_path / "map.txt"):
            answer = save_map(str(wrong))
            assert not answer.success and str(wrong) in answer.message and not wrong.exists()
