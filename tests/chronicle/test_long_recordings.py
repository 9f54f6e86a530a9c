"""What the recorder and the chronicle keep of a long session: little, and the same in the file as before."""

from __future__ import annotations

import io

import pytest

from cramhy_runtime.chronicle.chunk_index import PackedIndexes, pack_indexes
from cramhy_runtime.chronicle.chunks import Chunk, first_chunk
from cramhy_runtime.chronicle.history import Packed
from cramhy_runtime.chronicle.merge import FluentLists, State, TaskTrees
from cramhy_runtime.ros.message_json import to_json
from cramhy_runtime.ros.messages import message_class_exact

TASK, TREE = message_class_exact("cramhy_msgs/Task"), message_class_exact("cramhy_msgs/TaskTree")
FLUENT, FLUENTS = message_class_exact("cramhy_msgs/Fluent"), message_class_exact("cramhy_msgs/Fluents")


def written(pack):
    """The bytes of a recording with many chunks, and how its writer keeps their index."""
    writer_module = pytest.importorskip("mcap.writer", reason="pip install mcap")
    file = io.BytesIO()
    writer = writer_module.Writer(file, chunk_size=100)
    if pack:
        pack_indexes(writer)
    writer.start()
    number = writer.register_schema("a", "jsonschema", b"{}")
    channels = [writer.register_channel(f"/topic{each}", "json", number) for each in range(5)]
    for moment in range(2000):
        writer.add_message(channels[moment % 5], 10**18 + moment, b"x" * (moment % 70), 10**18 + moment, moment)
    writer.finish()
    return file.getvalue(), writer._Writer__chunk_indices


def test_a_recording_is_the_same_to_the_last_byte_with_its_index_packed():
    plain, objects = written(False)
    packed, indexes = written(True)
    assert isinstance(indexes, PackedIndexes) and len(indexes) == len(objects) > 300
    assert packed == plain
    assert [vars(each) for each in indexes] == [vars(each) for each in objects]
    assert len(indexes._packed) < 120 * len(indexes)


def filled(ours, size=3000):
    """The bytes of a recording whose topics appear one after the other, and what filled its chunks."""
    writer_module = pytest.importorskip("mcap.writer", reason="pip install mcap")
    file = io.BytesIO()
    writer = writer_module.Writer(file, chunk_size=size)
    chunk = first_chunk(writer) if ours else None
    writer.start()
    writer.add_metadata("a", {"b": "c"})
    writer.flush()
    channels = {}
    for moment in range(400):
        name, time, data = f"/topic{moment * moment % (1 + moment // 50)}", 10**18 + moment // 3, b"x" * (moment % 70)
        if name not in channels:
            channels[name] = writer.register_channel(name, "json", writer.register_schema(name, "jsonschema", b"{}"))
        if ours:
            chunk.add(channels[name], moment, time, data)
            if chunk.count > size:
                writer.flush()
        else:
            writer.add_message(channels[name], time, data, time, moment)
    writer.finish()
    return file.getvalue(), chunk


def test_a_recording_is_the_same_to_the_last_byte_when_we_fill_its_chunks():
    plain, _ = filled(False)
    ours, chunk = filled(True)
    assert isinstance(chunk, Chunk) and ours == plain
    reader = pytest.importorskip("mcap.reader").make_reader(io.BytesIO(ours), validate_crcs=True)
    assert sum(1 for _ in reader.iter_messages()) == reader.get_summary().statistics.message_count == 400
    assert len(reader.get_summary().chunk_indexes) > 5


def test_a_writer_of_another_make_keeps_its_index_and_fills_its_chunks_as_it_likes():
    class Writer:
        def __init__(self):
            self.added = []

        def add_message(self, *message):
            self.added.append(message)

    pytest.importorskip("mcap.writer", reason="pip install mcap")
    writer = Writer()
    pack_indexes(writer)
    chunk = first_chunk(writer)
    chunk.add(3, 7, 10**18, b"x")
    assert writer.added == [(3, 10**18, b"x", 10**18, 7)] and chunk.count == 0


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
