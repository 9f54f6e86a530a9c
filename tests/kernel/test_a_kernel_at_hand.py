"""What may be asked outside of any plan finds a kernel at hand: the active one, or one for the moment."""

import pytest

from cramhy_runtime import kernel


@pytest.fixture(autouse=True)
def none_is_active():
    with kernel.aside():
        yield


def test_the_active_one_is_taken_and_left():
    active = kernel.start()
    with kernel.at_hand():
        assert kernel.active() is active
    assert kernel.active() is active and not active.stopped


def test_one_for_the_moment_is_gone_afterwards_and_kept_for_the_next_moment():
    with kernel.at_hand():
        first = kernel.active()
        assert first is not None and kernel.current() is first.main
        with kernel.at_hand():
            assert kernel.active() is first
    assert kernel.active() is None
    with kernel.at_hand():
        assert kernel.active() is first


@pytest.mark.parametrize("use", [lambda: kernel.sleep(1), lambda: kernel.spawn(kernel.park), lambda: kernel.call_at(5, print)])
def test_one_in_which_something_happened_is_stopped(use):
    with kernel.at_hand():
        first = kernel.active()
        use()
    assert first.stopped and kernel.active() is None
    with kernel.at_hand():
        assert kernel.active() is not first and kernel.now() == 0.0


def test_so_is_one_whose_block_fails():
    with pytest.raises(ValueError), kernel.at_hand():
        first = kernel.active()
        raise ValueError
    assert first.stopped and kernel.active() is None


def test_a_kernel_that_is_started_meanwhile_stays():
    with kernel.at_hand():
        first, started = kernel.active(), kernel.start()
    assert first.stopped and kernel.active() is started


def test_a_kernel_has_slots_since_a_dictionary_of_thirty_attributes_is_slower_to_find_them_in():
    assert not hasattr(kernel.active() or kernel.start(), "__dict__")
