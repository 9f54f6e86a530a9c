"""What a notebook shows beside text: fluents over time, outlines, and cells while they run."""

from __future__ import annotations

import xml.etree.ElementTree as xml

import pytest

pytest.importorskip("ipykernel", reason="the extra jupyter is not installed")

from cramhy_runtime import cpl, kernel  # noqa: E402
from cramhy_runtime.cpl.fluents.fluents import Fluent  # noqa: E402
from cramhy_runtime.jupyter import live, outlines, plots  # noqa: E402
from cramhy_runtime.jupyter.plans import Plans  # noqa: E402

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture
def virtual():
    kernel.start("virtual")
    yield
    kernel.stop()


class Nothing:
    """A watcher of a world in which nothing moves."""

    def begin(self):
        pass

    def papers(self):
        return []

    def pictures(self):
        return []


class Said:
    """The messages of one cell."""

    def __init__(self):
        self.messages = []

    def __call__(self, kind, content):
        self.messages.append((kind, content["transient"]["display_id"], content["data"]))


def nested(html):
    """The HTML of an outline as nested lists of texts."""

    def parts(node):
        found = []
        for child in node:
            if child.tag == "details":
                summary, below = child
                found.append(["".join(summary.itertext()), *parts(below)])
            elif child.find(".//div") is not None:
                found += parts(child)
            else:
                found.append("".join(child.itertext()))
        return found

    return parts(xml.fromstring(f"<p>{html.replace('<details open>', '<details>')}</p>"))


# ------------------------------------------------------------------------------------------------------------ fluents over time


def watched(value, *changes):
    """A `Watched` with a fluent that gets a value every second."""
    fluent = cpl.make_fluent(name="SPEED", value=value)
    found = plots.Watched()
    found.watch([fluent])
    for change in changes:
        kernel.sleep(1)
        fluent.value = change
        kernel.settle()
        found.take()
    return found


def test_a_fluent_is_noted_with_the_times_of_its_changes(virtual):
    (series,) = watched(0, 1, 1, 4).series
    assert [(round(time, 6), value) for time, value in series.samples] == [(0, 0), (1, 1), (3, 4)]


def test_the_last_value_of_an_instant_counts(virtual):
    found = watched(0)
    fluent = found.series[0].fluent
    kernel.sleep(1)
    for number in range(5):
        fluent.value = number + 1
        found.take()
    assert found.series[0].samples == [(0, 0), (1, 5)]


def test_numbers_are_drawn_as_steps(virtual):
    picture = watched(0, 1, 4).picture()
    drawn = xml.fromstring(picture["image/svg+xml"])
    (line,) = [path.get("d") for path in drawn.iter(f"{SVG}path") if path.get("stroke") == plots.COLOURS[0]]
    assert line.count("H") == 3 and line.count("V") == 2  # two changes, and on to the present
    assert "SPEED" in picture["text/plain"] and {"0", "4", "0 s", "2 s"} <= {text.text for text in drawn.iter(f"{SVG}text")}


def test_other_values_are_drawn_as_bands_with_their_texts(virtual):
    drawn = xml.fromstring(watched("<idle>", "driving", "<idle>").picture()["image/svg+xml"])
    bands = [each for each in drawn.iter(f"{SVG}rect") if each.get("fill-opacity")]
    assert [each.get("fill") for each in bands] == [plots.COLOURS[0], plots.COLOURS[1], plots.COLOURS[0]]
    assert {'"<idle>"', '"driving"'} <= {text.text for text in drawn.iter(f"{SVG}text")}


def test_a_message_has_a_line_for_each_number(virtual):
    from cramhy_runtime.ros.messages import message_class_exact

    pose = message_class_exact("turtlesim/Pose")
    found = watched(None, pose(x=1.0, y=2.0, theta=0.5))
    assert list(plots.as_lines(found.series[0].samples)) == ["x", "y", "theta", "linear_velocity", "angular_velocity"]
    xml.fromstring(found.picture()["image/svg+xml"])


@pytest.mark.parametrize("value", [float("inf"), float("nan"), 10**400, -(10**400), 1e308])
def test_numbers_that_fit_on_no_paper_are_drawn(virtual, value):
    drawn = watched(0, value, 1).picture()["image/svg+xml"]
    xml.fromstring(drawn)
    assert "nan" not in drawn


def test_a_fluent_that_changes_for_ever_keeps_a_bounded_past(virtual):
    series = plots.Series(cpl.make_fluent(value=0))
    for number in range(5 * plots.MOST_VALUES):
        series.fluent.value = number
        series.take(float(number))
    assert len(series.samples) <= plots.MOST_VALUES + 1 and series.samples[0] == (0.0, 0.0)
    assert series.samples == sorted(series.samples)


def test_a_fluent_whose_value_cannot_be_computed_is_drawn(virtual):
    class Own(Fluent):
        """It has no method for its value."""

    found = plots.Watched()
    found.watch([Own("OWN")])
    assert "no value" in found.series[0].samples[0][1]


# -------------------------------------------------------------------------------------------------------------------- outlines


def test_an_outline_is_folded_by_its_levels():
    rows = [(0, "a"), (1, "b"), (3, "c"), (1, "d"), (0, "e")]
    assert nested(outlines.outline(rows)) == [["a", ["b", "c"], "d"], "e"]
    assert outlines.outline([]) == ""


def test_an_outline_has_an_end():
    html = outlines.outline([(number, str(number)) for number in range(1000)])
    assert nested(html)[-1] == "and 700 more"


def test_a_text_becomes_an_outline_and_runs_nothing():
    html = outlines.of_text("(goal <x>) has no solution.\n  <script>\n    deeper\n\n  others")
    assert nested(html) == [["(goal <x>) has no solution.", ["<script>", "deeper"], "others"]] and "<script>" not in html


# ------------------------------------------------------------------------------------------------------- cells while they run


def shown_of(plan, looked_at=True, clock=None):
    """The messages of a cell that runs ``plan()``."""
    said = Said()
    ticks = iter(range(10**6))
    shown = live.Live(live.Displays(said, "cell-1"), Nothing(), plots.Watched(), Plans(), clock=clock or (lambda: float(next(ticks))))
    try:
        with shown.during(looked_at):
            plan()
    except cpl.PlanFailure:
        pass
    return said.messages


def sleeps():
    cpl.top_level(lambda: cpl.par(lambda: [cpl.sleep(0.125) for _ in range(24)], lambda: cpl.sleep(1)))


def fails():
    cpl.top_level(lambda: cpl.par(lambda: cpl.sleep(3), lambda: cpl.fail("lost")))


def test_the_tree_of_a_plan_is_shown_in_one_place_while_it_runs(virtual):
    messages = shown_of(sleeps)
    assert [kind for kind, _, _ in messages] == ["display_data"] + ["update_display_data"] * (len(messages) - 1) and len(messages) > 2
    assert {place for _, place, _ in messages} == {"cell-1-plan"}
    during, end = messages[0][2], messages[-1][2]
    assert "waits for" in during["text/html"] and "which has ended" in end["text/plain"]
    (whole,) = nested(end["text/html"])
    assert len(whole[1]) == 3 and all("succeeded" in part for part in whole[1])  # the plan and its two branches, which are dead


def test_a_quick_cell_shows_nothing_of_its_plan(virtual):
    assert shown_of(sleeps, clock=lambda: 0.0) == []


def test_where_nobody_looks_on_nothing_is_shown_meanwhile(virtual):
    assert shown_of(sleeps, looked_at=False) == []


def test_a_plan_that_fails_is_shown_with_the_branches_that_are_dead(virtual):
    ((kind, _, data),) = shown_of(fails, looked_at=False)
    (whole,) = nested(data["text/html"])
    assert kind == "display_data" and "which failed" in data["text/plain"]
    assert "evaporated" in whole[1][1] and "lost" in whole[1][2]


def test_the_same_plan_takes_the_same_time_watched_and_unwatched(virtual):
    times = []
    for looked_at in (True, False):
        before = kernel.now()
        shown_of(sleeps, looked_at)
        times.append(round(kernel.now() - before, 9))
    assert times[0] == times[1] == 3


def test_an_object_that_cannot_be_printed_ends_the_looks_and_not_the_plan(virtual):
    class Broken(Nothing):
        def papers(self):
            raise ValueError("torn")

    said = Said()
    ticks = iter(range(10**6))
    shown = live.Live(live.Displays(said, "cell-1"), Broken(), plots.Watched(), Plans(), clock=lambda: float(next(ticks)))
    before = kernel.now()
    with shown.during(True):
        sleeps()
    assert kernel.now() - before == 3 and [kind for kind, _, _ in said.messages] == []
