"""Frames and TF."""

import copy
import time

import numpy as np
import rospy
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from driven_node import AT_ONCE, connected_node, poses_of, publish, transforms_of, wait_figure
from ros_system import wait_for

EXTRINSIC = [1.2, -0.3, 1.7, 0.4, 0.02, -0.01]  # x, y, z, yaw, pitch, roll of the LiDAR on the base


def extrinsic_matrix():
    x, y, z, yaw, pitch, roll = EXTRINSIC
    cy, sy, cp, sp, cr, sr = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch), np.cos(roll), np.sin(roll)
    pose = np.eye(4)
    pose[:3, :3] = (np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]]) @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
                    @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]]))
    pose[:3, 3] = x, y, z
    return pose


def test_tf_of_the_lidar(topics, drive):
    with connected_node(topics):
        topics.tf.wait_connected()
        publish(topics, drive.sweeps[:4])
        topics.tf.wait(4)
    stamped, transforms = transforms_of(topics.tf.messages, "velodyne")
    assert {t.header.frame_id for t in stamped} == {"odom"}
    assert [t.header.stamp.to_nsec() for t in stamped] == drive.offline.stamps[:4]
    np.testing.assert_allclose(transforms, drive.offline.poses[:4], rtol=0, atol=1e-9)


def test_tf_of_the_base_inverted_and_with_other_names(topics, drive):
    parameters = {"base_frame": "robot", "odom_frame": "lidar_odom", "base_to_lidar": EXTRINSIC, "invert_tf": True}
    with connected_node(topics, {**AT_ONCE, **parameters}):
        topics.tf.wait_connected()
        publish(topics, drive.sweeps[:4])
        topics.tf.wait(4)
    extrinsic = extrinsic_matrix()
    expected = extrinsic @ drive.offline.poses[:4] @ np.linalg.inv(extrinsic)
    stamped, transforms = transforms_of(topics.tf.messages, "lidar_odom")
    assert {t.header.frame_id for t in stamped} == {"robot"}
    np.testing.assert_allclose(np.linalg.inv(transforms), expected, rtol=0, atol=1e-9)
    np.testing.assert_allclose(poses_of(topics.odometry.messages), expected, rtol=0, atol=1e-9)
    assert topics.odometry.messages[0].header.frame_id == "lidar_odom"


def static_extrinsic(parent, child):
    """EXTRINSIC as it is on /tf_static, with a quaternion that has not quite length 1, as those of few digits."""
    pose = extrinsic_matrix()
    transform = TransformStamped()
    transform.header.frame_id, transform.child_frame_id = parent, child
    transform.transform.translation.x, transform.transform.translation.y, transform.transform.translation.z = pose[:3, 3]
    w = np.sqrt(1 + np.trace(pose[:3, :3])) / 2
    vector = np.array([pose[2, 1] - pose[1, 2], pose[0, 2] - pose[2, 0], pose[1, 0] - pose[0, 1]]) / (4 * w)
    rotation = transform.transform.rotation
    rotation.x, rotation.y, rotation.z, rotation.w = 1.004 * np.array([*vector, w])
    return TFMessage([transform])


def test_the_base_is_found_in_tf_also_by_names_with_a_slash(topics, drive):
    """As old drivers and launch files write them; tf2 looks up none of these. The transform comes once, before the
    sweeps, and from a publisher that does not latch it, as in a bag."""
    slashed = [copy.deepcopy(sweep) for sweep in drive.sweeps[:3]]
    for sweep in slashed:
        sweep.header.frame_id = "/velodyne"
    static = rospy.Publisher("/tf_static", TFMessage, queue_size=1)
    with connected_node(topics, {**AT_ONCE, "base_frame": "/base_link"}):
        topics.tf.wait_connected()
        wait_for(lambda: static.get_num_connections() > 0, "the node's subscription to /tf_static")
        static.publish(static_extrinsic("base_link", "velodyne"))
        time.sleep(0.2)  # on its way
        publish(topics, slashed)
        topics.tf.wait(3)
    static.unregister()
    extrinsic = extrinsic_matrix()
    expected = extrinsic @ drive.offline.poses[:3] @ np.linalg.inv(extrinsic)
    stamped, transforms = transforms_of(topics.tf.messages, "base_link")
    assert {t.header.frame_id for t in stamped} == {"odom"}
    np.testing.assert_allclose(transforms, expected, rtol=0, atol=1e-9)
    np.testing.assert_allclose(poses_of(topics.odometry.messages), expected, rtol=0, atol=1e-9)


def test_without_tf(topics, drive):
    with connected_node(topics, {**AT_ONCE, "publish_tf": False}):
        publish(topics, drive.sweeps[:2])
        wait_figure(topics, "sweeps registered", 2)
    assert not topics.tf.messages
