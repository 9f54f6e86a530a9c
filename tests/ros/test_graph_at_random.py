"""Whatever nodes do in whatever order, the graph shows who is there, and every message reaches who listened when it was sent."""

from systems import SOAK

from hypothesis import given, settings
from hypothesis import strategies as st

from cramhy_runtime import kernel
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.messages import message_class_exact

TEXT = message_class_exact("std_msgs/String")
NODES, HIDDEN, TOPICS = ("a", "b", "c"), ("watcher",), ("/x", "/y")
who, where = st.sampled_from(NODES + HIDDEN), st.sampled_from(TOPICS)
actions = st.one_of(
    st.tuples(st.just("advertise"), who, where, st.booleans()),
    st.tuples(st.just("unadvertise"), who, where),
    st.tuples(st.just("subscribe"), who, where),
    st.tuples(st.just("unsubscribe"), who, where),
    st.tuples(st.just("publish"), who, where),
    st.tuples(st.just("end"), who),
)


class World:
    """The graph, and beside it what should be so: who publishes and who listens where, and what each has heard."""

    def __init__(self):
        kernel.start(clock="virtual")
        self.graph = graph.active()
        self.nodes, self.publishing, self.listening, self.latched = {}, {}, {}, {}
        self.heard, self.expected, self.count = [], [], 0

    def node(self, name):
        if name not in self.nodes:
            self.nodes[name] = self.graph.node(name, hidden=name in HIDDEN)
        return self.nodes[name]

    def advertise(self, name, topic, latch):
        self.node(name).advertise(topic, TEXT, latch)
        self.publishing.setdefault((name, topic), latch)

    def unadvertise(self, name, topic):
        assert self.node(name).unadvertise(topic) is ((name, topic) in self.publishing)
        self.publishing.pop((name, topic), None)
        self.latched.pop((name, topic), None)

    def subscribe(self, name, topic):
        self.expected += [(name, topic, data) for (other, where), data in self.latched.items() if where == topic]
        self.node(name).subscribe(topic, TEXT, lambda message: self.heard.append((name, topic, message.data)))
        self.listening[name, topic] = self.listening.get((name, topic), 0) + 1

    def unsubscribe(self, name, topic):
        self.node(name).unsubscribe(topic)
        self.listening.pop((name, topic), None)

    def publish(self, name, topic):
        if (name, topic) in self.publishing:
            self.count += 1
            data = str(self.count)
            if self.publishing[name, topic]:
                self.latched[name, topic] = data
            listeners = [other for (other, where), times in self.listening.items() if where == topic for _ in range(times)]
            self.expected += [(other, topic, data) for other in listeners]
            sent = self.nodes[name].publications[topic].publish(TEXT(data=data))
            assert sent == sum(other not in HIDDEN for other in listeners)

    def end(self, name):
        if name in self.nodes:
            self.nodes.pop(name).shutdown()
            for table in (self.publishing, self.listening, self.latched):
                for key in [key for key in table if key[0] == name]:
                    del table[key]

    def check(self):
        assert sorted(self.heard) == sorted(self.expected)
        shown = {topic for name, topic in (*self.publishing, *self.listening) if name not in HIDDEN}
        assert list(self.graph.visible_topics()) == sorted(shown)
        assert list(self.graph.visible_nodes()) == sorted(f"/{name}" for name in self.nodes if name not in HIDDEN)
        assert set(self.graph.topics) == {topic for name, topic in (*self.publishing, *self.listening)}
        assert set(self.graph.nodes) == {f"/{name}" for name in self.nodes}


@settings(max_examples=2000 if SOAK else 60, deadline=None)
@given(st.lists(actions, max_size=40))
def test_the_graph_is_what_its_nodes_did(plan):
    world, told = World(), set()
    world.graph.on_change.append(lambda kind, name, there: told.add((kind, name)) if there else told.discard((kind, name)))
    try:
        for action, *arguments in plan:
            getattr(world, action)(*arguments)
            world.check()
            shown = world.graph
            assert told == {*(("node", name) for name in shown.visible_nodes()), *(("topic", name) for name in shown.visible_topics())}
    finally:
        kernel.stop()
