"""A program as a suit: what it gives is sent as it is, or refused with a reason."""

import numpy as np
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


STILL = np.tile([1.0, 0.0, 0.0, 0.0], (23, 1))


@pytest.fixture(params=["mxtp://127.0.0.1:9", "natnet://127.0.0.1:0?data-port=0"])
def to_nobody(request):
    """A streamer of each protocol."""
    with posewire.streamer(request.param) as streamer:
        yield streamer


def with_head(rows, *numbers):
    """A copy with other numbers for the Head."""
    rows = rows.copy()
    rows[6] = numbers
    return rows


@pytest.mark.parametrize(
    ("position", "orientation", "message"),
    [
        (np.zeros((23, 3)), with_head(STILL, 0, 0, 0, 0), r"length 1 as the orientation of Head, found \[0, 0, 0, 0\]"),
        (np.zeros((23, 3)), with_head(STILL, 3, 4, 0, 0), "of length 5.0000"),
        (np.zeros((23, 3)), with_head(STILL, np.nan, 0, 0, 1), r"nothing but NaN as the orientation of Head, found \[nan"),
        (with_head(np.zeros((23, 3)), 0, np.inf, 0), STILL, r"as the position of Head, found \[0, inf, 0\]"),
        (with_head(np.zeros((23, 3)), 0, 0, 1e39), STILL, "which 32 bits can hold, as the position of Head"),
        (with_head(np.zeros((23, 3)), 0, 0, np.nan), STILL, "nothing but NaN as the position of Head"),
        (np.zeros((23, 3), complex), STILL, "expected numbers as position, found an array of complex128"),
        (np.zeros((23, 3), bool), STILL, "expected numbers as position, found an array of bool"),
        ([["0", "0", "0"]] * 23, STILL, "expected numbers as position, found an array of <U1"),
        ([[None, None, None]] * 23, STILL, "expected numbers as position, found an array of object"),
        ([[0, 0, 0]] * 22 + [[0, 0]], STILL, "expected an array of numbers as position: "),
        (np.ma.masked_invalid(np.zeros((23, 3))), STILL, "without a mask as position"),
        (np.zeros(69), STILL, r"expected an array of \(23, 3\) as position, found one of \(69,\)"),
    ],
)
def test_numbers_that_no_pose_has_are_refused(to_nobody, position, orientation, message):
    with pytest.raises(posewire.UsageError, match=message):
        to_nobody.send(position, orientation)


def test_whatever_numpy_makes_an_array_of_is_taken(looped):
    class Tensor:
        """As those of other frameworks."""

        def __init__(self, array):
            self.array = array

        def __array__(self, dtype=None, copy=None):
            return self.array

    stream, streamer = looped
    position = np.arange(69, dtype=float).reshape(23, 3)
    given = [
        position,
        position.astype(np.float32),
        position.astype(int),
        position.astype(int).tolist(),
        np.asfortranarray(position),
        np.repeat(position, 2, axis=0)[::2],
        position[::-1][::-1],
        position.astype(">f8"),
        Tensor(position),
    ]
    for numbers in given:
        streamer.send(numbers, STILL.astype(np.float32))
    for _ in given:
        np.testing.assert_array_equal(stream.next(timeout=10).position, position)


def test_a_quaternion_that_is_nearly_one_is_made_one(looped):
    stream, streamer = looped
    streamer.send(np.zeros((23, 3)), STILL * 1.0009)
    np.testing.assert_array_equal(stream.next(timeout=10).orientation, STILL)
    # One that is as exact as 32 bits can have it goes out unchanged.
    turned = np.float32([0.6, 0.8, 0, 0]).astype(float)
    streamer.send(np.zeros((23, 3)), np.tile(turned, (23, 1)))
    np.testing.assert_array_equal(stream.next(timeout=10).orientation[3], turned)
