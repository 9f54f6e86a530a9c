"""Files of others: a description that is hostile, or only unusual, is read or refused in a moment, with file and line."""

import os
import subprocess
import sys
import time

import pytest

from cramhy_runtime.robot_world import description_files, urdf, xml_elements
from cramhy_runtime.robot_world.descriptions import DescriptionError
from cramhy_runtime.robot_world.mesh_files import MeshError, read_mesh

ROBOT = '<robot name="r"><link name="base"/></robot>'
COMMENTS = "<!-- a comment -->\n" * 60
"""As Tiago's published file has them; the old reader took twice as long for each."""
BILLION = "<!DOCTYPE r [<!ENTITY a '" + "x" * 1000 + "'>" + "".join(f"<!ENTITY a{n} '{'&a;' * 100}'>" for n in range(9)) + "]>"


@pytest.mark.parametrize(
    "text",
    [
        f"{COMMENTS}{ROBOT}",
        f'<?xml version="1.0"?>\n{COMMENTS}<?xacro x?>\n{COMMENTS}{ROBOT}',
        f"<?a b?>\n{'<?a b?>   ' * 60}{ROBOT}",
        f"<!-- {'- ' * 10_000} -->{ROBOT}",
        f"<!DOCTYPE robot>{COMMENTS}{ROBOT}",
        f"<!-- <mujoco> -->{ROBOT}",
    ],
)
def test_what_stands_before_the_robot_costs_no_time(text):
    began = time.process_time()
    for each in (text, text.encode()):
        assert description_files.read_text(each).name == "r" and xml_elements.root_name(each) == "robot"
    assert time.process_time() - began < 2  # of the processor; the old reader took hours


@pytest.mark.parametrize(
    ("text", "line", "element", "reason"),
    [
        (f"\n{BILLION}<robot/>", 2, "", "entities of its own are not read: they can make a small file huge."),
        ('<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><robot name="&x;"/>', 1, "", "entities of its own are not read"),
        ('<!DOCTYPE r [<!ENTITY % x SYSTEM "file:///etc/passwd"> %x;]>\n<robot/>', 1, "", "entities of its own are not read"),
        ("<robot>\n" + "<a>" * 2000, 2, "a", "more than 1000 elements are around this one."),
        ("<robot>\n" + "<a/>" * 3_001, 2, "a", "it has more than 3000 elements."),
        ("<robot name='" + "x" * 1_000_000, 1, "", "this is no XML: unclosed token, column 1."),
        ("<!--" + "-- " * 100_000, 1, "", "this is no XML"),
    ],
)
def test_a_hostile_text_is_refused_with_its_place(text, line, element, reason, monkeypatch):
    monkeypatch.setattr(xml_elements, "MOST_ELEMENTS", 3_000)
    with pytest.raises(DescriptionError) as caught:
        description_files.read_text(text, "evil.urdf")
    problem = caught.value
    assert (problem.file, problem.line, problem.element) == ("evil.urdf", line, element) and problem.reason.startswith(reason)
    assert str(problem).startswith(f"evil.urdf, line {line}")


def test_what_is_no_file_of_finite_size_is_refused(tmp_path, monkeypatch):
    pipe = tmp_path / "pipe.urdf"
    os.mkfifo(pipe)
    big = tmp_path / "big.urdf"
    big.write_text(ROBOT + " " * 100)
    monkeypatch.setattr(xml_elements, "MOST_BYTES", 64)
    for read in (description_files.read_file, urdf.read_file):
        for path in (pipe, "/dev/zero"):
            with pytest.raises(DescriptionError, match="this is not a regular file; a description is read from a file of finite size."):
                read(path)
        with pytest.raises(DescriptionError, match=r"big\.urdf: it has more than 0 MiB\."):
            read(big)
        with pytest.raises(OSError, match="No such file"):
            read(tmp_path / "none.urdf")
    for ending in ("stl", "obj", "dae"):
        (tmp_path / f"pipe.{ending}").hardlink_to(pipe)
        with pytest.raises(MeshError, match="this is not a regular file"):
            read_mesh(tmp_path / f"pipe.{ending}")


def test_a_signal_ends_the_reading_of_a_long_text():
    """The parser gives Python its turn again and again, whatever the text is."""
    code = (
        "import signal\nfrom cramhy_runtime.robot_world import description_files\n"
        "text = '<robot name=\"r\">' + '<!-- c -->' * 100\n"
        "signal.signal(signal.SIGALRM, lambda *_: exit(7))\nsignal.setitimer(signal.ITIMER_REAL, 0.2)\n"
        "while True:\n    try:\n        description_files.read_text('<!-- x -->' * 100_000 + text)\n    except ValueError:\n        pass\n"
    )
    assert subprocess.run([sys.executable, "-c", code], timeout=60).returncode == 7


@pytest.mark.parametrize(
    ("inside", "line", "element"),
    [
        ('<replicate count="100000"><geom size="1"/></replicate>', 2, "replicate"),
        ('<replicate count="1000">\n<replicate count="1000"><body/></replicate></replicate>', 3, "replicate"),
        ('<body><composite type="grid" count="1000 1000 1"/></body>', 2, "composite"),
        ("<body/>" * 6000, 2, "body"),
    ],
)
def test_a_model_that_mujoco_would_read_for_minutes_is_refused(inside, line, element):
    pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")
    text = f"<mujoco><worldbody>\n{inside}</worldbody></mujoco>"
    with pytest.raises(DescriptionError) as caught:
        description_files.read_text(text, "evil.xml")
    assert str(caught.value) == (
        f"evil.xml, line {line}, in <{element}>: it makes more than 5000 bodies and geoms, which MuJoCo needs too long to read."
    )


def test_included_files_count(tmp_path):
    pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")
    (tmp_path / "many.xml").write_text("<mujoco>" + '<worldbody><geom size="1"/></worldbody>' * 3000 + "</mujoco>")
    main = tmp_path / "main.xml"
    main.write_text('<mujoco><include file="many.xml"/><include file="many.xml"/></mujoco>')
    with pytest.raises(DescriptionError, match=r"many\.xml, line 1, in <geom>: it makes more than 5000 bodies"):
        description_files.read_file(main)
    main.write_text('<mujoco>\n<include file="main.xml"/></mujoco>')
    with pytest.raises(DescriptionError, match=r"main\.xml, line 2, in <include>: more than 100 files are included\."):
        description_files.read_file(main)
