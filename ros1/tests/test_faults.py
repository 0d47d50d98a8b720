"""What goes wrong on a robot."""

import numpy as np
import rospy
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

import ros_bag
from driven_node import connected_node, figures, poses_of, publish, wait_figure
from ros_system import wait_for


def test_a_queue_of_one_keeps_the_freshest_sweep(topics, drive):
    """While the transform is missing the node takes no further sweep: what comes meanwhile must be dropped."""
    with connected_node(topics, {"queue": 1, "look_ahead": 0, "base_frame": "base_link"}):
        for sweep in drive.sweeps[:10]:
            topics.points.publish(sweep)
        report = wait_figure(topics, "messages received", 10)
        assert int(report["sweeps dropped"]) in (8, 9)  # one or none was taken before the second came
        waiting = wait_for(lambda: "waiting for" in figures(topics)["message"] and figures(topics), "the complaint")
        assert waiting["level"] == 2 and "base_link" in waiting["message"]
        transform = TransformStamped()
        transform.header.frame_id, transform.child_frame_id = "base_link", "velodyne"
        transform.transform.translation.z, transform.transform.rotation.w = 1.5, 1
        static = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        static.publish(TFMessage([transform]))
        expected = 10 - int(report["sweeps dropped"])
        messages = topics.odometry.wait(expected)
        report = wait_figure(topics, "sweeps registered", expected)
        static.unregister()
    assert int(report["sweeps dropped"]) == 10 - expected
    assert messages[-1].header.stamp.to_nsec() == drive.offline.stamps[9]
    assert messages[-1].child_frame_id == "base_link"


def test_a_message_that_cannot_be_read_is_reported_and_left_out(topics, drive):
    broken = [ros_bag.cloud(np.zeros(10, ros_bag.POINT), ros_bag.FIRST_STAMP_NS) for _ in range(3)]
    broken[0].fields = broken[0].fields[1:]
    broken[1].is_bigendian = True
    broken[2].data = broken[2].data[:50]
    with connected_node(topics):
        publish(topics, drive.sweeps[:2])
        for sweep in broken:
            topics.points.publish(sweep)
        publish(topics, drive.sweeps[2:5], 5)
        report = wait_figure(topics, "sweeps registered", 5)
    assert report["messages that cannot be read"] == "3"
    assert "message 5 of /points" in report["last that cannot be read"]
    assert any("cannot be read" in m.status[0].message for m in topics.diagnostics.messages)
    np.testing.assert_allclose(poses_of(topics.odometry.messages), drive.offline.poses[:5], rtol=0, atol=1e-9)


def test_a_jump_back_in_time_starts_anew(topics, drive):
    with connected_node(topics):
        publish(topics, drive.sweeps[12:15])
        publish(topics, drive.sweeps[:3], 6)
        report = wait_figure(topics, "sweeps registered", 6)
    assert (report["jumps back in time"], report["resets"]) == ("1", "1")
    np.testing.assert_allclose(poses_of(topics.odometry.messages)[3:], drive.offline.poses[:3], rtol=0, atol=1e-9)
