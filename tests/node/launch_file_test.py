"""What the ROS 2 launch file starts, with ROS 2's own modules played by stand-ins that keep what they are given.

    launch_file_test.py FILE
"""

import importlib.util
import sys
import types
from types import SimpleNamespace


class Kept(SimpleNamespace):
    def __init__(self, *values, **named):
        super().__init__(kind=type(self).__name__, values=values, **named)


def stand_in(module, *names):
    sys.modules[module] = types.ModuleType(module)
    for name in names:
        setattr(sys.modules[module], name, type(name, (Kept,), {}))


def load(file):
    stand_in("launch", "LaunchDescription")
    stand_in("launch.actions", "DeclareLaunchArgument", "OpaqueFunction")
    stand_in("launch_ros")
    stand_in("launch_ros.actions", "ComposableNodeContainer", "LoadComposableNodes", "Node")
    stand_in("launch_ros.descriptions", "ComposableNode")
    stand_in("launch_ros.parameter_descriptions", "ParameterValue")
    stand_in("ament_index_python")
    stand_in("ament_index_python.packages")
    sys.modules["ament_index_python.packages"].get_package_share_directory = lambda package: f"/share/{package}"
    spec = importlib.util.spec_from_file_location("odometry_launch", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def started(module, namespace=None, **given):
    *declared, function = module.generate_launch_description().values[0]
    defaults = {argument.values[0]: argument.default_value for argument in declared}
    assert len(defaults) == len(declared), "an argument twice"
    assert set(given) <= set(defaults), "no such argument"
    assert all(argument.description for argument in declared)
    pushed = {} if namespace is None else {"ros_namespace": namespace}
    return function.function(SimpleNamespace(launch_configurations={**defaults, **given, **pushed}))


def plain(parameters):
    """Without the wrapper that keeps texts from being read as YAML."""
    assert isinstance(parameters.get("base_frame", Kept()), Kept)
    assert all(value.value_type is str for value in parameters.values() if isinstance(value, Kept))
    return {name: value.values[0] if isinstance(value, Kept) else value for name, value in parameters.items()}


def main():
    module = load(sys.argv[1])
    node, = started(module)
    assert (node.kind, node.package, node.executable) == ("Node", "rilo_ros2", "rilo_node")
    assert node.parameters == ["/share/rilo_ros2/config/odometry.yaml", {}]
    assert node.remappings == [("points", "points")]

    node, viewer = started(module, points="/velodyne_points", queue="0", publish_tf="False", base_frame="base_link",
                           use_sim_time="true", rviz="true", reliable="true")
    assert node.remappings == [("points", "/velodyne_points")]
    placed, = started(module, base_frame="base_link", base_to_lidar="[1, -0.5, 1.7, 0, 0, 0.1]")
    assert plain(placed.parameters[1]) == {"base_frame": "base_link", "base_to_lidar": [1.0, -0.5, 1.7, 0.0, 0.0, 0.1]}
    for wrong, told in (({"publish_tf": "1"}, "publish_tf: expected true or false, found 1"),
                        ({"queue": "two"}, "queue: expected a whole number, found two"),
                        ({"base_to_lidar": "1 2"}, "base_to_lidar: expected a list of numbers, found 1 2"),
                        ({"rviz": "yes"}, "rviz: expected true or false, found yes")):
        try:
            started(module, **wrong)
        except ValueError as error:
            assert str(error) == told, error
        else:
            raise AssertionError(f"{wrong} is taken")
    overrides = "qos_overrides./velodyne_points.subscription."
    assert plain(node.parameters[1]) == {
        "queue": 0, "publish_tf": False, "base_frame": "base_link", "use_sim_time": True,
        overrides + "reliability": "reliable", overrides + "history": "keep_last", overrides + "depth": 100}
    assert viewer.arguments == ["-d", "/share/rilo_ros2/rviz/odometry.rviz"]

    for namespace, points, topic in (("/robot", "lidar/points", "/robot/lidar/points"),
                                     ("a/b", "points", "/a/b/points"),
                                     ("/robot", "/points", "/points"), (None, "points", "/points")):
        node, = started(module, namespace, points=points, reliable="true")
        assert f"qos_overrides.{topic}.subscription.depth" in node.parameters[1], node.parameters[1]

    loaded, = started(module, container="/sensors")
    component, = loaded.composable_node_descriptions
    assert (loaded.kind, loaded.target_container) == ("LoadComposableNodes", "/sensors")
    assert component.plugin == "rilo::ros2::OdometryNode"
    assert component.extra_arguments == [{"use_intra_process_comms": True}]
    container, = started(module, container="own")
    assert (container.kind, container.executable) == ("ComposableNodeContainer", "component_container")


if __name__ == "__main__":
    main()
