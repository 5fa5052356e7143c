"""Skeletons: MVN's, and those of other segments."""

import copy
import pickle

import numpy as np
import pytest
from conftest import until

import posewire

ARM = ["Base", "Upper", "Fore"]


def test_mvn_has_up_to_four_props_and_forty_fingers():
    assert len(posewire.Skeleton.standard()) == 23
    assert len(posewire.Skeleton.standard(4, fingers=True)) == 67
    assert len(posewire.Skeleton.standard(props=np.int64(2))) == 25


def test_a_skeleton_says_which_segments_wear_sensors():
    assert len(posewire.Skeleton.standard().sensors) == 17
    assert posewire.Skeleton.standard(sensors=["Head", "Pelvis"]).sensors == ["Head", "Pelvis"]
    assert posewire.Skeleton.standard(sensors=[]).sensors == []
    with pytest.raises(posewire.UsageError, match='expected names of segments as the sensors, found "Nose"'):
        posewire.Skeleton.standard(sensors=["Nose"])
    with pytest.raises(posewire.UsageError, match='found "Head" twice'):
        posewire.Skeleton.standard(sensors=["Head", "Pelvis", "Head"])


@pytest.mark.parametrize("props", [-1, 5, 200, 2**40, -(2**63), 2**64, 10**500])
def test_other_numbers_of_props_are_wrong_arguments(props):
    with pytest.raises(posewire.UsageError, match="expected a whole number from 0 to 4 as props, found "):
        posewire.Skeleton.standard(props=props)


@pytest.mark.parametrize("props", [1.0, "1", None])
def test_what_is_no_whole_number_is_a_type_error(props):
    with pytest.raises(TypeError, match="as an integer"):
        posewire.Skeleton.standard(props=props)


def test_a_skeleton_can_be_of_other_segments():
    arm = posewire.Skeleton(ARM, [None, 0, 1], [[0, 0, 0], [0, 0, 1], [np.nan, 0, 0]])
    assert (arm.segments, arm.parents, arm.joints, len(arm)) == (ARM, [None, 0, 1], [], 3)
    np.testing.assert_array_equal(arm.origins, [[0, 0, 0], [0, 0, 1], [np.nan] * 3])
    assert repr(arm) == "<posewire.Skeleton: 3 segments, 0 joints>"
    loose = posewire.Skeleton(segments=ARM)
    assert loose.parents == [None] * 3 and np.isnan(loose.origins).all()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([],), "expected the names of segments, found none"),
        ((["Base", ""],), 'expected a name of its own for each segment, found ""'),
        ((["Base", "Base"],), 'expected a name of its own for each segment, found "Base"'),
        ((["a\0b"],), "expected a name of its own"),
        ((ARM, [None, 0]), "expected 3 parents, one for each segment, found 2"),
        ((ARM, [0, None, None]), 'expected None as the parent of "Base", the first segment, found 0'),
        ((ARM, [None, 2, 1]), 'expected a whole number from 0 to 0 as the parent of "Upper", found 2'),
        ((ARM, [None, 0, -1]), 'expected a whole number from 0 to 1 as the parent of "Fore", found -1'),
        ((ARM, None, np.zeros((2, 3))), r"expected an array of \(3, 3\) as origins, found one of \(2, 3\)"),
        ((ARM, None, np.zeros(3)), r"expected an array of \(3, 3\) as origins, found one of \(3,\)"),
        ((ARM, None, "nowhere"), r"expected an array of \(3, 3\) as origins, found str"),
    ],
)
def test_what_is_no_skeleton_is_a_wrong_argument(arguments, message):
    with pytest.raises(posewire.UsageError, match=message):
        posewire.Skeleton(*arguments)


def test_skeletons_are_equal_when_what_they_hold_is():
    assert posewire.Skeleton.standard() == posewire.Skeleton.standard() != posewire.Skeleton.standard(props=1)
    assert posewire.Skeleton(ARM) == posewire.Skeleton(ARM) != posewire.Skeleton(ARM, [None, 0, 1])
    assert posewire.Skeleton(ARM) != ARM
    assert len({posewire.Skeleton.standard(), posewire.Skeleton.standard(), posewire.Skeleton(ARM)}) == 2


@pytest.mark.parametrize(
    "skeleton",
    [
        posewire.Skeleton.standard(),
        posewire.Skeleton.standard(2, fingers=True),
        posewire.Skeleton.standard(sensors=["Head", "Pelvis"]),
        posewire.Skeleton(ARM, [None, 0, 1], [[0, 0, 0], [0, 0, 1], [np.nan] * 3]),
    ],
)
def test_skeletons_are_pickled_and_copied(skeleton):
    assert pickle.loads(pickle.dumps(skeleton)) == skeleton
    assert copy.copy(skeleton) is skeleton and copy.deepcopy([skeleton])[0] is skeleton


def test_natnet_carries_any_skeleton():
    arm = posewire.Skeleton(ARM, [None, 0, 1], [[0, 0, 0], [0, 0, 1], [0, 0, 2]])
    position, orientation = np.arange(9.0).reshape(3, 3), np.tile([1.0, 0, 0, 0], (3, 1))
    with posewire.streamer("natnet://127.0.0.1:0?data-port=0", skeleton=arm, names=["Robot"]) as streamer:
        with posewire.listen(streamer.urls[0]) as stream:
            until(lambda: streamer.notices)
            streamer.send(position, orientation)
            frame = stream.next(timeout=10)
            assert frame.subject == "Robot"
            assert (frame.segments, frame.skeleton.parents) == (ARM, arm.parents)
            np.testing.assert_allclose(frame.position, position, atol=1e-6)


def test_mxtp_carries_the_segments_without_their_names():
    position, orientation = np.arange(9.0).reshape(3, 3), np.tile([1.0, 0, 0, 0], (3, 1))
    with posewire.listen("mxtp://127.0.0.1:0") as stream:
        with posewire.streamer(stream.url, skeleton=posewire.Skeleton(ARM)) as streamer:
            streamer.send(position, orientation)
            frame = stream.next(timeout=10)
            assert frame.segments == ["Segment1", "Segment2", "Segment3"]
            np.testing.assert_array_equal(frame.position, position)
