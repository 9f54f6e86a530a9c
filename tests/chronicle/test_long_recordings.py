"""What the recorder and the chronicle keep of a long session: little, and the same in the file as before."""

from __future__ import annotations

import io

import pytest

from cramhy_runtime.chronicle.chunk_index import PackedIndexes
from cramhy_runtime.chronicle.history import Packed
from cramhy_runtime.chronicle.merge import FluentLists, State, TaskTrees
from cramhy_runtime.chronicle.writing import Writer
from cramhy_runtime.ros.message_json import to_json
from cramhy_runtime.ros.messages import message_class_exact

TASK, TREE = message_class_exact("cramhy_msgs/Task"), message_class_exact("cramhy_msgs/TaskTree")
FLUENT, FLUENTS = message_class_exact("cramhy_msgs/Fluent"), message_class_exact("cramhy_msgs/Fluents")


def writers(file, ours, size):
    """A writer to ``file``, and what adds a message with its channel, its number there, its time and its data: of ours, or of mcap."""
    mcap_writer = pytest.importorskip("mcap.writer", reason="pip install mcap")
    if not ours:
        writer = mcap_writer.Writer(file, chunk_size=size)
        return writer, lambda channel, number, time, data: writer.add_message(channel, time, data, time, number)
    writer = Writer(file, size)

    def add(*message):
        writer.chunk.add(*message)
        if writer.chunk.count > size:
            writer.flush()

    return writer, add


def written(ours):
    """The bytes of a recording with many chunks, and the index of them that its writer keeps."""
    file = io.BytesIO()
    writer, add = writers(file, ours, 100)
    writer.start(profile="", library="a library")
    number = writer.register_schema("a", "jsonschema", b"{}")
    channels = [writer.register_channel(f"/topic{each}", "json", number) for each in range(5)]
    for moment in range(2000):
        add(channels[moment % 5], moment, 10**18 + moment, b"x" * (moment % 70))
    writer.finish()
    return file.getvalue(), writer._indexes if ours else writer._Writer__chunk_indices


def test_a_recording_is_the_same_to_the_last_byte_with_its_index_packed():
    plain, objects = written(False)
    packed, indexes = written(True)
    assert isinstance(indexes, PackedIndexes) and len(indexes) == len(objects) > 300
    assert packed == plain
    assert [vars(each) for each in indexes] == [vars(each) for each in objects]
    assert len(indexes._packed) < 120 * len(indexes)


def filled(ours, size=3000):
    """The bytes of a recording whose topics appear one after the other."""
    file = io.BytesIO()
    writer, add = writers(file, ours, size)
    writer.start(profile="", library="a library")
    writer.add_metadata("a", {"b": "c"})
    writer.flush()
    channels = {}
    for moment in range(400):
        name, time, data = f"/topic{moment * moment % (1 + moment // 50)}", 10**18 + moment // 3, b"x" * (moment % 70)
        if name not in channels:
            channels[name] = writer.register_channel(name, "json", writer.register_schema(name, "jsonschema", b"{}" * size))
        add(channels[name], moment, time, data)
    writer.add_metadata("d", {})
    channels["silent"] = writer.register_channel("silent", "json", 1)
    writer.finish()
    return file.getvalue()


def test_a_recording_is_the_same_to_the_last_byte_when_we_fill_its_chunks():
    ours = filled(True)
    assert ours == filled(False)
    reader = pytest.importorskip("mcap.reader").make_reader(io.BytesIO(ours), validate_crcs=True)
    assert sum(1 for _ in reader.iter_messages()) == reader.get_summary().statistics.message_count == 400
    assert len(reader.get_summary().chunk_indexes) > 5


def test_a_recording_without_messages_is_the_same_to_the_last_byte():
    written = []
    for ours in (True, False):
        file = io.BytesIO()
        writer, _ = writers(file, ours, 100)
        writer.start(profile="", library="a library")
        writer.finish()
        written.append(file.getvalue())
    assert written[0] == written[1]


def test_the_state_of_a_session_keeps_nothing_of_what_is_gone():
    state = State()
    for number in range(3000):
        state.add("tasks", TREE(tasks=[TASK(id=str(number))], removed=[str(number - 10)]))
        state.add("fluents", FLUENTS(fluents=[FLUENT(id=str(number))], removed=[str(number - 10)]))
    for kind in ("tasks", "fluents"):
        kept = state.sums[kind]
        assert len(kept.things) == 10 and kept.removed == [] and kept.copy().removed == []
        assert kept.message(True).complete is True and kept.message(True).removed == []


def test_what_is_published_still_tells_what_is_gone():
    for made, message in ((TaskTrees(), TREE(removed=["7"])), (FluentLists(), FLUENTS(removed=["7"]))):
        made.add(message)
        assert made.changed and made.message().removed == ["7"] and made.message().complete is None


def test_packed_messages_are_read_as_they_were_while_more_are_added_and_after_that():
    packed = Packed()
    messages = [TREE(stamp=float(number), tasks=[TASK(id=str(number), name="dr\xc3\xbcben", result="\xff" * 3)]) for number in range(300)]
    for number, message in enumerate(messages, 1):
        packed.append("tasks", message)
        if number in (1, 100):
            assert [to_json(each) for each in packed.read()["tasks"]] == [to_json(each) for each in messages[:number]]
    packed.append("tasks", TREE(stamp="no number"))  # nobody could be sent it
    packed.close()
    packed.close()
    found = packed.read()
    assert [to_json(each) for each in found["tasks"]] == [to_json(each) for each in messages]
    assert found["world"] == found["fluents"] == found["modules"] == []
    assert len(packed._bytes) < 40 * len(messages)
