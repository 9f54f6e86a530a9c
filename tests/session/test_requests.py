"""Requests beside the prompt: how they end, whose debugger their errors open, and when time passes."""

from __future__ import annotations

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.session import requests
from cramhy_runtime.session.requests import DONE, FAILED, INTERRUPTED, Mailbox, Request, request_of
from cramhy_runtime.session.session import Session


@pytest.fixture
def session():
    made = Session(time="virtual", turtlesim=False)
    yield made
    conditions.install_router(None)
    kernel.stop()


def test_a_request_gives_what_its_work_returns(session):
    ended = []
    request = Request(lambda: session.evaluate_text("(progn (sleep 5) 7)"), ended.append)
    kernel.sleep(10)
    assert ended == [request] and request.outcome == DONE and request.result == [7]


def test_a_request_that_fails_gives_the_failure(session):
    ended = []
    request = Request(lambda: session.evaluate_text("(car 5)"), ended.append)
    kernel.sleep(1)
    assert ended == [request] and request.outcome == FAILED and "LIST" in str(request.failure)


def test_an_interrupt_ends_the_plan_through_its_cleanup(session):
    ended = []
    request = Request(lambda: session.evaluate_text("(unwind-protect (sleep 1000) (setf *cleaned* t))"), ended.append)
    kernel.sleep(1)
    request.interrupt()
    assert not ended
    kernel.sleep(1)
    assert ended == [request] and request.outcome == INTERRUPTED and session.evaluate_text("*cleaned*") == [True]
    request.interrupt()
    assert len(ended) == 1


def test_a_request_that_has_not_begun_never_begins(session):
    ended, began = [], []
    request = Request(lambda: began.append(1), ended.append)
    request.interrupt()
    kernel.sleep(1)
    assert ended == [request] and request.outcome == INTERRUPTED and not began


def test_errors_of_a_request_and_its_tasks_open_its_debugger(session):
    requests.ask_whoever_asked()
    heard, others = [], []
    conditions.install_debugger(others.append)
    try:
        Request(lambda: session.evaluate_text("(car 5)"), lambda request: None, debugger=lambda problem: heard.append(request_of()))
        kernel.sleep(1)
        assert len(heard) == 1 and heard[0] is not None and others == []
        with pytest.raises(conditions.Condition):
            session.evaluate_text("(car 6)")
        assert len(others) == 1 and request_of() is None
    finally:
        conditions.install_debugger(None)


def test_time_stands_still_while_somebody_thinks(session):
    """The main task is at the prompt; only a request in the debugger is there, and it waits for its user."""
    mailbox, ended = Mailbox(), []
    Request(lambda: request_of().wait(mailbox), ended.append)
    kernel.sleep(1)
    before = kernel.now()
    assert kernel.active().clock.wanted == 0
    mailbox.put("answer")
    kernel.yield_()
    kernel.settle()
    assert ended[0].result == "answer" and kernel.now() == before and kernel.active().clock.wanted == 0
