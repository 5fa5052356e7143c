"""A program as a suit: what it gives is sent as it is, or refused with a reason."""

import numpy as np  # noqa: F401
import pytest

import posewire


def test_a_skeleton_says_which_segments_wear_sensors():
    assert len(posewire.Skeleton.standard().sensors) == 17
    assert posewire.Skeleton.standard(sensors=["Head", "Pelvis"]).sensors == ["Head", "Pelvis"]
    assert posewire.Skeleton.standard(sensors=[]).sensors == []
    with pytest.raises(posewire.UsageError, match='expected names of segments as the sensors, found "Nose"'):
        posewire.Skeleton.standard(sensors=["Nose"])
    with pytest.raises(posewire.UsageError, match='found "Head" twice'):
        posewire.Skeleton.standard(sensors=["Head", "Pelvis", "Head"])
