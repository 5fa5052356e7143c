"""A frame is a take of one sample: the same names, the same numbers."""

import numpy as np
import pytest

import posewire


def test_a_frame_has_what_a_take_has(walk):
    of_take, of_frame = ({name for name in dir(one) if name[0] != "_"} for one in (posewire.Take, posewire.Frame))
    assert of_take - of_frame == {"complete", "damage", "frame", "to_arrow", "write"}
    frame = walk.frame(7)
    for section in walk.sections:
        np.testing.assert_array_equal(frame[section], walk[section][7])
        if not section.startswith(("joint_angles", "ergonomic_angles")):
            np.testing.assert_array_equal(getattr(frame, section), frame[section])
    for section in ("sensor_orientation", "center_of_mass_velocity", "center_of_mass_acceleration"):
        assert section in walk.sections and hasattr(frame, section)
    assert (frame.rate, frame.skeleton.segments) == (walk.rate, walk.segments)
    assert list(frame.contacts) == list(walk.contacts[7])


@pytest.mark.parametrize("over", ["a file", "the wire"])
def test_data_of_sensors_arrive(walk, tmp_path, over):
    sensors = [section for section in walk.sections if section.startswith("sensor_")]
    assert len(sensors) == 5
    if over == "a file":
        walk.write(tmp_path / "walk.mvnx", last=3)
        with posewire.listen(tmp_path / "walk.mvnx") as stream:
            frames = list(stream)
    else:
        with posewire.listen("mxtp://127.0.0.1:0") as stream:
            with posewire.streamer(stream.url, skeleton=walk.skeleton, types="all") as streamer:
                for place in range(4):
                    numbers = {section: walk[section][place] for section in sensors}
                    streamer.send(walk.position[place], walk.orientation[place], **numbers)
                frames = [stream.next(timeout=10) for _ in range(4)]
    for place, frame in enumerate(frames):
        for section in sensors:
            np.testing.assert_allclose(getattr(frame, section), walk[section][place], rtol=1e-5, atol=1e-5)
