"""The graph without any Lisp program: nodes in Python, hidden observers, calls that nobody waits for."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ros import graph, services
from cramhy_runtime.ros.messages import message_class_exact, service_type_exact

TEXT = message_class_exact("std_msgs/String")
EMPTY, ADD = service_type_exact("std_srvs/Empty"), service_type_exact("roscpp_tutorials/TwoInts")


@pytest.fixture
def here():
    return graph.active()


@pytest.fixture
def unhandled(monkeypatch):
    """The exceptions that were reported because nobody else heard of them."""
    reported = []
    monkeypatch.setattr(kernel.reports.installed.reporter, "unhandled", lambda task, problem: reported.append(str(problem)))
    return reported


def add(request):
    return ADD.response(sum=request.a + request.b)


class TestHiddenNodes:
    """An observer of ours changes nothing that users see."""

    def test_it_is_in_no_list(self, here):
        watcher = here.node("cramhy_view", hidden=True)
        watcher.advertise("/cramhy/tasks", TEXT)
        watcher.subscribe("/only_it_listens", TEXT, print)
        watcher.serve("/cramhy/pause", EMPTY, print)
        talker = here.node("talker")
        talker.advertise("/chatter", TEXT)
        watcher.subscribe("/chatter", TEXT, print)
        talker.serve("/add", ADD, add)
        assert list(here.visible_nodes()) == ["/talker"]
        assert list(here.visible_topics()) == ["/chatter"]
        assert list(here.visible_services()) == ["/add"]
        assert here.topics["/chatter"].visible_subscriptions == []
        assert "/cramhy/pause" in here.services  # which can be called all the same

    def test_it_hears_everything_and_does_not_count(self, here):
        heard, publication = [], here.node("talker").advertise("/chatter", TEXT, latch=True)
        publication.publish(TEXT(data="before"))
        watcher = here.node("cramhy_view", hidden=True)
        subscription = watcher.subscribe("/chatter", TEXT, lambda message: heard.append(message.data))
        assert (publication.publish(TEXT(data="after")), publication.subscribers, heard) == (0, 0, ["before", "after"])
        here.node("listener").subscribe("/chatter", TEXT, lambda message: None)
        assert (publication.publish(TEXT(data="both")), publication.subscribers) == (1, 1)
        watcher.unsubscribe(subscription)
        assert (publication.publish(TEXT(data="one")), publication.subscribers, len(heard)) == (1, 1, 3)

    def test_it_takes_its_things_along(self, here):
        publication = here.node("talker").advertise("/chatter", TEXT)
        watcher = here.node("cramhy_view", hidden=True)
        watcher.subscribe("/chatter", TEXT, print)
        watcher.shutdown()
        assert (publication.connections, publication.hidden) == ([], 0)

    def test_the_programs_publications_print_without_it(self, running):
        from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
        from cramhy_runtime.ros.roslisp import topics

        publication = topics.advertise("chatter", "std_msgs/String")
        before = prin1_to_string(publication)
        running.graph.node("cramhy_view", hidden=True).subscribe("/chatter", TEXT, print)
        assert prin1_to_string(publication) == before
        assert topics.num_subscribers(publication) == 0


class TestChanges:
    """Who appends a function to ``on_change`` is told what visible things come and go."""

    @pytest.fixture
    def changes(self, here):
        seen = []
        here.on_change.append(lambda kind, name, there: seen.append(f"{'+' if there else '-'} {kind} {name}"))
        return seen

    def test_nodes_topics_and_services_come_and_go(self, here, changes):
        talker, listener = here.node("talker"), here.node("listener")
        talker.advertise("/chatter", TEXT)
        listener.subscribe("/chatter", TEXT, print)
        talker.serve("/add", ADD, add)
        talker.shutdown()
        listener.shutdown()
        assert changes == [
            "+ node /talker",
            "+ node /listener",
            "+ topic /chatter",
            "+ service /add",
            "- service /add",
            "- node /talker",
            "- topic /chatter",
            "- node /listener",
        ]

    def test_of_hidden_ones_only_what_others_have_too(self, here, changes):
        watcher, talker = here.node("cramhy_view", hidden=True), here.node("talker")
        watcher.subscribe("/chatter", TEXT, print)
        watcher.serve("/cramhy/pause", EMPTY, print)
        assert changes == ["+ node /talker"]
        talker.advertise("/chatter", TEXT)
        watcher.shutdown()
        assert changes[1:] == ["+ topic /chatter"]
        talker.unadvertise("/chatter")
        assert changes[2:] == ["- topic /chatter"]

    def test_an_observer_that_fails_hinders_nobody(self, here, changes, unhandled):
        here.on_change.insert(0, lambda *_: 1 / 0)
        here.node("talker")
        assert changes == ["+ node /talker"]
        assert unhandled == ["division by zero"]


class TestPythonNodes:
    def test_a_node_may_listen_to_a_topic_twice(self, here):
        heard, publication = [], here.node("talker").advertise("/chatter", TEXT)
        listener = here.node("listener")
        first = listener.subscribe("/chatter", TEXT, lambda message: heard.append(("first", message.data)))
        listener.subscribe("/chatter", TEXT, lambda message: heard.append(("second", message.data)))
        assert publication.publish(TEXT(data="a")) == 2
        listener.unsubscribe(first)
        assert publication.publish(TEXT(data="b")) == 1
        listener.unsubscribe("/chatter")
        assert publication.publish(TEXT(data="c")) == 0
        assert sorted(heard) == [("first", "a"), ("second", "a"), ("second", "b")]

    def test_a_callback_that_fails_hinders_neither_the_others_nor_the_publisher(self, here, unhandled):
        heard, publication = [], here.node("talker").advertise("/chatter", TEXT)
        for callback in (lambda message: 1 / 0, heard.append):
            here.node(f"n{len(here.nodes)}").subscribe("/chatter", TEXT, callback)
        assert publication.publish(TEXT(data="a")) == 2
        assert (len(heard), unhandled) == (1, ["division by zero"])

    def test_a_callback_may_unsubscribe_whom_it_likes(self, here):
        heard, publication = [], here.node("talker").advertise("/chatter", TEXT)
        listeners = [here.node(f"listener{number}") for number in range(3)]
        for listener in listeners:
            listener.subscribe(
                "/chatter",
                TEXT,
                lambda message, node=listener: (
                    heard.append(node.name),
                    [other.unsubscribe("/chatter") for other in listeners if other is not node],
                ),
            )
        publication.publish(TEXT(data="a"))
        assert len(heard) == 1

    def test_a_spinning_node_goes_on_after_a_callback_that_failed(self, here, unhandled):
        heard, publication = [], here.node("talker").advertise("/chatter", TEXT)
        spinner = here.node("spinner", spins=True)
        spinner.subscribe("/chatter", TEXT, lambda message: 1 // len(message.data))
        spinner.subscribe("/chatter", TEXT, lambda message: heard.append(message.data))
        for text in ("a", "", "b"):
            publication.publish(TEXT(data=text))
        assert heard == []
        spinner.spin_once()
        assert (heard, len(unhandled)) == (["a", "", "b"], 1)


class TestCallsThatNobodyWaitsFor:
    """``start_call`` works in callbacks of the scheduler, where nothing can wait."""

    def call_in_the_scheduler(self, name, request):
        """The calls that were told to be done, and what was told when the call had just been made."""
        told, at_once = [], []

        def start():
            services.start_call(graph.active().services[name], request, told.append)
            at_once.append(len(told))

        kernel.post(start)
        kernel.sleep(1)
        return told, at_once[0]

    def test_a_node_that_does_not_spin_answers_at_once(self, here):
        here.node("server").serve("/add", ADD, add)
        told, at_once = self.call_in_the_scheduler("/add", ADD.request(a=3, b=4))
        assert ([call.response.sum for call in told], at_once) == ([7], 1)

    def test_the_simulator_answers_in_its_next_tick(self, simulator):
        told, at_once = self.call_in_the_scheduler("/spawn", service_type_exact("turtlesim/Spawn").request(name="t2"))
        assert ([call.response.name for call in told], at_once) == (["t2"], 0)
        told, _ = self.call_in_the_scheduler("/spawn", service_type_exact("turtlesim/Spawn").request(name="t2"))
        assert [(call.response, call.failure, call.lost) for call in told] == [(None, "", False)]

    def test_a_service_of_the_program_answers_in_its_own_task(self, running):
        from cramhy_runtime.ros.roslisp import services as roslisp

        roslisp.register_service_fn("add", lambda request: kernel.sleep(0.5) or add(request), "roscpp_tutorials/TwoInts")
        told, at_once = self.call_in_the_scheduler("/add", ADD.request(a=1, b=1))
        assert ([call.response.sum for call in told], at_once) == ([2], 0)

    def test_a_server_that_goes_away_loses_the_call(self, simulator):
        told = []
        service = simulator.node.graph.services["/clear"]
        services.start_call(service, EMPTY.request(), told.append)
        simulator.shutdown()
        assert [(call.done, call.lost) for call in told] == [(True, True)]
        assert services.start_call(service, EMPTY.request(), told.append).lost  # and one that is gone already does, too

    def test_a_request_that_cannot_be_sent_fails(self, here):
        here.node("server").serve("/add", ADD, add)
        told, _ = self.call_in_the_scheduler("/add", ADD.request(a="three"))
        assert [call.failure for call in told] == ['The value\n  "three"\nis not of type\n  INTEGER']

    def test_a_broken_handler_is_told_to_the_caller_and_reported(self, here, unhandled):
        here.node("server").serve("/add", ADD, lambda request: 1 / 0)
        assert services.exchange(here.services["/add"], ADD.request()).failure == "error processing request: division by zero"
        assert unhandled == ["division by zero"]
        here.node("server").serve("/add", ADD, lambda request: None)
        assert services.exchange(here.services["/add"], ADD.request()).failure.startswith("error processing request: ")
