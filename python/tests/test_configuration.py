"""Configurations and settings in all their forms."""

from collections import ChainMap
from types import MappingProxyType

import numpy as np
import pytest

import rilo


def test_configuration():
    assert "voxel_m: 0.5" in rilo.dump_config(settings=["map.voxel_m=0.5"])
    assert "max_iterations: 7" in rilo.dump_config("icp: {max_iterations: 7}")
    with pytest.raises(rilo.ConfigError, match="icp.max_iteration.*max_iterations"):
        rilo.Odometry("icp: {max_iteration: 7}")
    with pytest.raises(ValueError, match="voxel_m"):
        rilo.Odometry(settings=["map.voxel_m=-1"])


def test_settings_are_dicts_or_texts():
    nested = rilo.dump_config(settings={"map": {"voxel_m": 0.25}, "icp": {"max_iterations": np.int64(9)}})
    assert "voxel_m: 0.25" in nested and "max_iterations: 9" in nested
    assert nested == rilo.dump_config(settings={"map.voxel_m": np.float32(0.25), "icp.max_iterations": 9})
    assert nested == rilo.dump_config({"map": {"voxel_m": 0.25}}, ["icp.max_iterations=9"])
    assert nested == rilo.Odometry(settings={"map.voxel_m": 0.25, "icp.max_iterations": 9}).config()
    for argument in "settings", "config":
        with pytest.raises(rilo.ConfigError, match=f"^{argument} map.voxel=0.25: unknown key .* map.voxel_m"):
            rilo.Odometry(**{argument: {"map": {"voxel": 0.25}}})
    with pytest.raises(rilo.ConfigError, match=r'^settings map: there is no "=".*Example: icp.max_iterations=20'):
        rilo.Odometry(settings=["map"])
    with pytest.raises(TypeError, match=r"map.voxel_m: got \[1\] of type list; expected a number"):
        rilo.Odometry(settings={"map.voxel_m": [1]})
    with pytest.raises(TypeError, match="settings: got 'map.voxel_m=1' of type str; expected a dict or a list"):
        rilo.Odometry(settings="map.voxel_m=1")
    endless = {}
    endless["map"] = endless
    with pytest.raises(TypeError, match="settings: nested too deep at map.map"):
        rilo.Odometry(settings=endless)
    with pytest.raises(TypeError, match="config: got 3"):
        rilo.Odometry(3)


def test_a_configuration_file_is_a_path(tmp_path):
    file = tmp_path / "my.yaml"
    file.write_text("map: {voxel_m: 0.75}\n")
    assert "voxel_m: 0.75" in rilo.dump_config(file) and "voxel_m: 0.75" in rilo.dump_config(str(file))


def test_bools_are_settings():
    on = rilo.dump_config(settings={"coarse.enabled": True})
    off = rilo.dump_config(settings={"coarse.enabled": False})
    assert on != off and off == rilo.dump_config(settings=["coarse.enabled=false"])


def test_settings_are_any_mapping():
    wanted = rilo.dump_config(settings={"map.voxel_m": 0.25})
    for mapping in (MappingProxyType({"map": MappingProxyType({"voxel_m": 0.25})}), ChainMap({"map.voxel_m": 0.25})):
        assert rilo.dump_config(settings=mapping) == rilo.dump_config(mapping) == wanted
    assert rilo.dump_config(settings={"map.voxel_m": np.array(0.25)}) == wanted
    with pytest.raises(TypeError, match=r"map.voxel_m: got array\(\[1, 2\]\) of type ndarray; expected a number"):
        rilo.Odometry(settings={"map.voxel_m": np.array([1, 2])})


def test_text_without_keys_is_a_path(tmp_path):
    with pytest.raises(rilo.ConfigError, match="^my_config: no such file"):
        rilo.Odometry("my_config")
    (tmp_path / "vlp16").write_text("map: {voxel_m: 0.75}\n")
    assert "voxel_m: 0.75" in rilo.dump_config(str(tmp_path / "vlp16"))
