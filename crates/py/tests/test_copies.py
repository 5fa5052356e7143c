"""What can be copied, pickled and referred to weakly."""

import copy
import gc
import multiprocessing
import pickle
import weakref

import numpy as np
import pytest

import posewire


def test_takes_and_frames_are_not_changed_and_copy_as_themselves(walk):
    for thing in (walk, walk.frame(0)):
        assert copy.copy(thing) is thing and copy.deepcopy({"thing": thing})["thing"] is thing


def test_takes_and_frames_say_what_is_pickled_instead(walk):
    with pytest.raises(TypeError, match=r"take\.write"):
        pickle.dumps(walk)
    with pytest.raises(TypeError, match="its arrays can"):
        pickle.dumps(walk.frame(0))
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(walk.position)), walk.position)
    with pytest.raises(TypeError, match="pickle its lists"):
        pickle.dumps(walk.skeleton)


def test_nothing_is_kept_for_a_weak_reference():
    take = posewire.read("synthetic:walk", duration=0.1)
    skeleton = posewire.Skeleton.standard()
    references = [weakref.ref(take), weakref.ref(skeleton)]
    assert all(reference() is not None for reference in references)
    del take, skeleton
    gc.collect()
    assert [reference() for reference in references] == [None, None]


def errors():
    return [kind for kind in vars(posewire).values() if isinstance(kind, type) and issubclass(kind, posewire.Error)]


@pytest.mark.parametrize("kind", errors(), ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("help", [None, "do this"])
def test_errors_are_pickled_and_copied(kind, help):
    error = kind("it went wrong", help)
    for again in (pickle.loads(pickle.dumps(error)), copy.copy(error), copy.deepcopy(error)):
        assert type(again) is kind and (again.message, again.help, str(again)) == (error.message, help, str(error))


def fail():
    posewire.read("there is no such take.mvnx")


def test_errors_come_back_from_other_processes():
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        with pytest.raises(posewire.ReadError, match="there is no such take.mvnx") as raised:
            pool.apply(fail)
    assert raised.value.help
