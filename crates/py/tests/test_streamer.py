"""A program as a suit: what it gives is sent as it is, or refused with a reason."""

import socket
import time

import numpy as np
import pytest
from conftest import until

import posewire

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
        (
            np.zeros((23, 3)),
            with_head(STILL, np.nan, 0, 0, 1),
            r"nothing but NaN as the orientation of Head, found \[nan",
        ),
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


def numbers(take, *sections, place=100):
    """The numbers of sections of a sample."""
    return {section: take[section][place] for section in sections}


POSE = ("position", "orientation")
TRACKERS = ("sensor_orientation", "sensor_free_acceleration", "sensor_magnetic_field")
INERTIAL = (*TRACKERS, "sensor_acceleration", "sensor_angular_velocity")
CENTER = ("center_of_mass", "center_of_mass_velocity", "center_of_mass_acceleration")


@pytest.mark.parametrize(
    ("types", "sections", "message"),
    [
        (
            None,
            (*POSE, "velocity"),
            "velocity is not sent: datagram type 21 carries it, and those that are sent are 02,12",
        ),
        (None, ("sensor_orientation",), 'types="02,12,13,20,23,24,25" sends it'),
        ("20", POSE, "position is not sent: datagram type 01,02,05,21 carries it"),
        ("all", (*POSE, "velocity"), "type 21 carries it only together with acceleration"),
        ("all", ("position",), "only together with orientation"),
        ("all", (*POSE, "angular_acceleration"), "give angular_velocity= as well"),
        ("all", ("sensor_orientation",), "sensor_free_acceleration and sensor_magnetic_field"),
        ("all", (*TRACKERS, "sensor_acceleration"), "only together with sensor_angular_velocity"),
        ("all", ("ergonomic_angles",), "only together with joint_angles"),
        ("all", ("joint_angles_xzy",), "neither MXTP nor NatNet has a place for it"),
        ("all", CENTER[:2], "only together with center_of_mass_acceleration"),
        ("all", CENTER[1:], "expected the position of the centre of mass"),
        ("all", (), "expected something to send"),
    ],
)
def test_what_the_types_do_not_carry_is_refused(walk, types, sections, message):
    with posewire.streamer("mxtp://127.0.0.1:9", types=types) as streamer:
        with pytest.raises(posewire.UsageError, match=message):
            streamer.send(**numbers(walk, *sections))


def test_what_natnet_does_not_carry_is_refused(walk):
    natnet = "natnet://127.0.0.1:0?data-port=0"
    given = numbers(walk, *POSE, "velocity", "acceleration")
    with posewire.streamer(natnet) as streamer:
        with pytest.raises(posewire.UsageError, match="velocity is not sent: NatNet has no place for it"):
            streamer.send(**given)
        with pytest.raises(posewire.UsageError, match="expected the orientation of Pelvis beside its position"):
            streamer.send(walk.position[0])
    # Beside a target that has a place for it, it is sent there.
    with posewire.listen("mxtp://127.0.0.1:0") as stream:
        with posewire.streamer(natnet, stream.url, types="all") as streamer:
            streamer.send(**given)
            assert "velocity" in stream.next(timeout=10).sections


def test_targets_are_told_in_the_order_given():
    urls = ["mxtp://127.0.0.1:9", "natnet://127.0.0.1:0?data-port=0", "mxtp://127.0.0.1:10"]
    with posewire.streamer(*urls) as streamer:
        schemes = [url.split(":")[0] for url in streamer.urls]
        assert schemes == ["mxtp", "natnet", "mxtp"] and streamer.urls[2].endswith(":10")
        assert [target["endpoint"] for target in streamer.progress()["targets"]] == streamer.urls
    with pytest.raises(posewire.UsageError, match="NatNet has no datagram types"):
        posewire.streamer(urls[1], types="all")


def test_contacts_and_events_have_no_place_on_the_wire(to_nobody, walk):
    for name in ["contacts", "events"]:
        with pytest.raises(posewire.UsageError, match=f"{name} cannot be sent: neither MXTP nor NatNet"):
            to_nobody.send(walk.position[0], walk.orientation[0], **{name: [True] * 4})


def test_half_of_what_is_sent_together_is_refused(walk):
    orientation, angles = walk.orientation[0].copy(), walk.ergonomic_angles()[0].copy()
    orientation[6] = angles[2] = np.nan
    with posewire.streamer("mxtp://127.0.0.1:9", types="all") as streamer:
        with pytest.raises(
            posewire.UsageError, match="expected the orientation of Head beside its position, found none"
        ):
            streamer.send(walk.position[0], orientation)
        with pytest.raises(posewire.UsageError, match="all the ergonomic angles or none"):
            streamer.send(joint_angles=walk.joint_angles()[0], ergonomic_angles=angles)


def test_sensors_arrive_at_the_segments_that_wear_them(walk):
    skeleton = posewire.Skeleton.standard(sensors=["Head", "Pelvis"])
    with posewire.listen("mxtp://127.0.0.1:0") as stream:
        with posewire.streamer(stream.url, skeleton=skeleton, types="02,13,23") as streamer:
            rows = {section: take_rows[[2, 0]] for section, take_rows in numbers(walk, *INERTIAL).items()}
            streamer.send(walk.position[100], walk.orientation[100], **rows)
            frame = stream.next(timeout=10)
    worn = [frame.skeleton.sensors.index(name) for name in skeleton.sensors]
    for section in INERTIAL:
        np.testing.assert_allclose(frame[section][worn], rows[section], rtol=1e-7, atol=1e-37)
        assert np.isnan(np.delete(frame[section], worn, axis=0)).all()


def test_the_clocks_of_the_program_are_sent(walk):
    with posewire.listen("mxtp://127.0.0.1:0") as stream:
        with posewire.streamer(stream.url) as streamer:
            streamer.send(**numbers(walk, *POSE), time=12.345, timecode=3661.5, sample=70)
            frame = stream.next(timeout=10)
            assert (frame.sample, frame.time, frame.timecode) == (70, 12.345, 3661.5)
            with pytest.raises(posewire.UsageError, match="at most 4294967.295 seconds"):
                streamer.send(**numbers(walk, *POSE), time=1.7e9)
            with pytest.raises(posewire.UsageError, match="expected seconds from 0 on as the time, found -1"):
                streamer.send(**numbers(walk, *POSE), time=-1)
            with pytest.raises(posewire.UsageError, match="from 0 to 86400 as the timecode"):
                streamer.send(**numbers(walk, *POSE), timecode=1e5)
        with posewire.streamer(stream.url, types="02") as streamer:
            with pytest.raises(posewire.UsageError, match="timecode is not sent: datagram type 25"):
                streamer.send(**numbers(walk, *POSE), timecode=1)


def test_what_a_slow_receiver_misses_is_counted(walk):
    with socket.create_server(("127.0.0.1", 0)) as server:
        with posewire.streamer(f"mxtp+tcp://127.0.0.1:{server.getsockname()[1]}", types="all") as streamer:
            assert streamer.dropped == 0 and streamer.progress()["kind"] == "stream"
            given = numbers(walk, *POSE, "velocity", "acceleration", "joint_angles")
            connection, _ = server.accept()
            # It takes nothing: the system's buffers fill, then the queue of 256 samples, and sending goes on.
            until(lambda: streamer.send(**given) or streamer.dropped > 0)
            target = streamer.progress()["targets"][0]
            assert target["dropped"] > 0 and target["peers"] == 1
            connection.close()


def test_a_receiver_that_has_gone_is_told(walk):
    with socket.create_server(("127.0.0.1", 0)) as server:
        url = f"mxtp+tcp://127.0.0.1:{server.getsockname()[1]}"
        with posewire.streamer(url) as streamer:
            server.accept()[0].close()
            server.close()
            until(lambda: streamer.send(**numbers(walk, *POSE)) or streamer.dropped > 0)
            until(lambda: len(streamer.notices) == 3)
            connected, lost, refused = streamer.notices
            assert connected.startswith("connected to 127.0.0.1:")
            assert lost.startswith("lost the connection to 127.0.0.1:") and refused.endswith("; trying again")
        dropped = streamer.dropped
        assert streamer.closed and dropped > 0 and streamer.progress()["lost"] == dropped


def test_natnet_clients_are_told_of(walk):
    with posewire.streamer("natnet://127.0.0.1:0?data-port=0") as streamer:
        with posewire.listen(streamer.urls[0]) as stream:
            until(lambda: streamer.send(**numbers(walk, *POSE)) or stream.latest(timeout=0.01))
            until(lambda: streamer.notices)
            assert streamer.notices[0].startswith("connected to 127.0.0.1:")
            until(lambda: [client["frames"] > 0 for client in streamer.progress()["targets"][0]["clients"]] == [True])
        until(lambda: "has left" in streamer.notices[-1])


def nowhere():
    """An address that the system has no way to, if there is one."""
    try:
        with socket.socket(socket.AF_INET6, socket.SOCK_DGRAM) as probe:
            probe.sendto(b"", ("2001:db8::1", 9763))
    except OSError:
        return "mxtp://[2001:db8::1]:9763"
    pytest.skip("this machine has a way to every address")


def test_what_ends_it_is_raised_by_the_next_sample(walk):
    streamer = None
    with pytest.raises(posewire.NetworkError, match="cannot send to") as raised:
        with posewire.streamer(nowhere()) as streamer:
            until(lambda: streamer.send(**numbers(walk, *POSE)))
    if streamer is None:
        pytest.skip("it could not even be opened")
    assert streamer.closed and raised.value.message in streamer.notices
    with pytest.raises(posewire.ClosedError, match="the streamer is closed: cannot send to"):
        streamer.send(**numbers(walk, *POSE))
    streamer.close()


def test_close_raises_what_no_sample_has_told(walk):
    with pytest.raises(posewire.NetworkError, match="cannot send to"):
        streamer = posewire.streamer(nowhere())
        streamer.send(**numbers(walk, *POSE))
        streamer.close()


@pytest.mark.parametrize(
    ("url", "arguments", "message"),
    [
        ("x", {}, "x: motion cannot be sent there, expected mxtp://HOST:PORT, mxtp.tcp://HOST:PORT or natnet://HOST"),
        ("take.mcap", {}, "take.mcap: motion cannot be sent there"),
        ("take.mvnx", {}, "take.mvnx: motion cannot be sent there"),
        ("synthetic:walk", {}, "motion cannot be sent there"),
        ("osc://127.0.0.1", {}, "unknown scheme"),
        (None, {"names": []}, "expected a name for each subject, found none"),
        (None, {"names": "Ada"}, "expected a list of names, found 'Ada'"),
        (None, {"names": ["Ada", "Bob", "Ada"]}, 'expected each name once, found "Ada" twice'),
        (None, {"names": ["Ada\nname:Bob"]}, "expected names of one line"),
        (None, {"names": [" "]}, "expected names of one line"),
        (None, {"names": ["A" * 1025]}, "at most 1024 bytes in UTF-8, found one of 1025"),
        (None, {"names": [str(number) for number in range(257)]}, "at most 256 subjects"),
        (None, {"rate": 0}, "expected from 0.001 to 100000 samples a second as the rate, found 0"),
        (None, {"rate": float("nan")}, "found NaN"),
        (None, {"rate": float("inf")}, "found inf"),
        (None, {"rate": -1}, "found -1"),
        (None, {"rate": 1e9}, "found 1000000000"),
        ("natnet://127.0.0.1:0?data-port=0", {"types": "02"}, "expected no types= without an MXTP url"),
        ("natnet://127.0.0.1:0?data-port=0", {"names": ["A" * 256]}, "at most 255 bytes"),
    ],
)
def test_what_cannot_be_opened_is_refused(url, arguments, message):
    with pytest.raises(posewire.UsageError, match=message):
        posewire.streamer(url or "mxtp://127.0.0.1:9", **arguments)


def test_numbers_and_subjects_that_there_are_not_are_refused(to_nobody, walk):
    pose = numbers(walk, *POSE)
    for sample in [-1, 2**32, 2**70]:
        with pytest.raises(posewire.UsageError, match="expected a whole number from 0 to"):
            to_nobody.send(**pose, sample=sample)
    for subject in ["Zoe", 1, -1, 1.5]:
        with pytest.raises(posewire.UsageError, match='expected one of the subjects "posewire", found'):
            to_nobody.send(**pose, subject=subject)
    with pytest.raises(posewire.UsageError, match="expected where to send to"):
        posewire.streamer()


def test_subjects_of_a_moment_have_one_number(walk):
    with posewire.listen("mxtp://127.0.0.1:0") as stream:
        with posewire.streamer(stream.url, names=["Ada", "Bob"]) as streamer:
            for name in ["Ada", "Ada", "Bob", "Ada", "Bob", "Bob", "Ada"]:
                streamer.send(**numbers(walk, *POSE), subject=name)
            streamer.send(**numbers(walk, *POSE), subject="Bob", sample=10)
            streamer.send(**numbers(walk, *POSE), subject=0)
            frames = [stream.next(timeout=10) for _ in range(9)]
    numbered = {name: [frame.sample for frame in frames if frame.subject == name] for name in ["Ada", "Bob"]}
    assert numbered == {"Ada": [0, 1, 2, 3, 10], "Bob": [1, 2, 3, 10]}


def test_subjects_of_a_moment_share_a_natnet_frame(walk):
    def frames(streamer):
        return [client["frames"] for client in streamer.progress()["targets"][0]["clients"]]

    with posewire.streamer("natnet://127.0.0.1:0?data-port=0", names=["Ada", "Bob"]) as streamer:
        with posewire.listen(streamer.urls[0]) as stream:
            until(lambda: streamer.notices)
            for _ in range(20):
                streamer.send(**numbers(walk, *POSE), subject="Ada")
                # However long the program takes for the others.
                time.sleep(0.02)
                streamer.send(**numbers(walk, *POSE), subject="Bob")
            until(lambda: frames(streamer) == [20])
            got = [stream.next(timeout=10) for _ in range(40)]
            assert sorted((frame.sample, frame.subject) for frame in got) == [
                (sample, name) for sample in range(20) for name in ["Ada", "Bob"]
            ]


SENT = {
    "position": 0,
    "orientation": 0,
    "velocity": 0,
    "acceleration": 0,
    "angular_velocity": 0,
    "angular_acceleration": 0,
    "center_of_mass": 0,
    "center_of_mass_velocity": 0,
    "center_of_mass_acceleration": 0,
    **dict.fromkeys(INERTIAL, 0),
    # Degrees on the wire.
    "joint_angles": 2e-7,
    "ergonomic_angles": 2e-7,
}


def test_every_section_comes_back_as_32_bits_have_it(walk):
    skeleton = walk.skeleton
    with posewire.listen("mxtp://127.0.0.1:0") as stream:
        with posewire.streamer(stream.url, skeleton=skeleton, names=["Zoë"], types="all") as streamer:
            for place in range(100):
                streamer.send(**numbers(walk, *SENT, place=place))
            frames = [stream.next(timeout=10) for _ in range(100)]
    for place, frame in enumerate(frames):
        assert (frame.sample, frame.subject) == (place, "Zoë")
        assert abs(frame.time - place / 240) <= 1e-3
        for section, bound in SENT.items():
            expected = walk[section][place]
            expected = expected.astype(np.float32) if bound == 0 else expected
            np.testing.assert_allclose(frame[section], expected, rtol=bound, atol=bound, err_msg=section)
    assert frame.segments == skeleton.segments and frame.joints == skeleton.joints
    np.testing.assert_array_equal(frame.skeleton.origins, skeleton.origins.astype(np.float32))


@pytest.mark.parametrize("version", ["3.1", "4.1"])
def test_poses_come_back_over_natnet(walk, version):
    with posewire.streamer(f"natnet://127.0.0.1:0?data-port=0&version={version}", names=["Zoë"]) as streamer:
        with posewire.listen(streamer.urls[0]) as stream:
            until(lambda: streamer.notices)
            for place in range(50):
                streamer.send(**numbers(walk, *POSE, place=place), time=place / 7)
            frames = [stream.next(timeout=10) for _ in range(50)]
    for place, frame in enumerate(frames):
        assert (frame.sample, frame.subject) == (place, "Zoë")
        assert frame.time == pytest.approx(place / 7, abs=1e-9)
        for section in POSE:
            np.testing.assert_array_equal(frame[section], walk[section][place].astype(np.float32), err_msg=section)
    assert frame.segments == walk.segments
