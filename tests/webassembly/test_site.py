"""The site of ``cramhy browser``, in Chromium and Firefox: both lectures, typed at its prompt without a network, give the answers of the terminal.

Making the site takes half a minute of the processor, so `make soak` runs these; what the command says of mistakes is always tested.
"""

from __future__ import annotations

import contextlib
import functools
import gzip
import os
import re
import signal
import socket
import subprocess
import sys
import threading
import urllib.error
import urllib.request
from pathlib import Path

import pytest
from browsers import KINDS, browser, chromium
from node import node, pyodide

from cramhy_runtime import cli
from cramhy_runtime.browser import left_out, local_host, pyodide_files, site

ROOT = Path(__file__).parents[2]
LIMIT = 120_000  # ms; for a machine that is busy with other things
PLACE = re.compile(r"/\S*/(?=cram_my_beginner_tutorial/)")
"""What differs: where the tutorial is."""
NATIVE = """
from lectures import LECTURE_34, LECTURE_38, Typist
from cramhy_runtime.repl.console import Console
from cramhy_runtime.repl.session import Session
class Terminal(Typist):
    shows_open = True
Console(lambda: Session(time="virtual"), Terminal([*LECTURE_34, *LECTURE_38])).run()
"""
pytestmark = pytest.mark.timeout(3000)


def native_transcript():
    """Both lectures, typed in virtual time at the prompt of this machine."""
    environment = {key: value for key, value in os.environ.items() if key != "ROS_PACKAGE_PATH"}
    environment |= {"PYTHONPATH": os.pathsep.join(str(ROOT / folder) for folder in ("src", "hy_src", "tutorials")), "PYTHONHASHSEED": "0"}
    done = subprocess.run([sys.executable, "-c", NATIVE], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=600)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


@contextlib.contextmanager
def served(folder):
    """The address of a folder that a static host serves, and a function that ends the host."""
    server = local_host.open_host(folder)
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()

    def end():
        if thread.is_alive():
            server.shutdown()
            server.server_close()
            thread.join()

    try:
        yield local_host.address(server), end
    finally:
        end()


@functools.cache
def written(folder):
    """The folder of a site, which the command has written below ``folder``. CRAMHY_SITE names one that is there already."""
    if "CRAMHY_SITE" in os.environ:
        return Path(os.environ["CRAMHY_SITE"])
    node()
    pyodide()
    out = folder / "site"
    assert cli.main(["browser", "--out", str(out)]) == 0
    return out


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return written(tmp_path_factory.getbasetemp())


@pytest.fixture
def kind():
    """Which browser visits the site. A test that is parametrized with ``kind`` has others."""
    return "chromium"


@pytest.fixture
def visit(made, kind):
    """A page of the site at its first prompt, and a function that cuts the network."""
    with served(made) as (address, cut), browser(kind) as started:
        context = started.new_context(viewport={"width": 1500, "height": 900})
        context.set_default_timeout(LIMIT)
        page = context.new_page()
        complaints = []
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.add_init_script(
            "window.violations = []; document.addEventListener('securitypolicyviolation', "
            "(event) => window.violations.push(`${event.violatedDirective} ${event.blockedURI}`));"
        )
        page.goto(f"{address}?speed=unbounded")
        wait_for_prompt(page)
        yield page, cut
        assert (complaints, page.evaluate("window.violations")) == ([], [])
        context.close()


def wait_for_state(page, *states):
    """Wait until the prompt is in one of the states, or Python has stopped. (The page's policy forbids what waits for functions.)"""
    page.locator(", ".join(f"body[data-prompt={state}]" for state in (*states, "failed", "ended"))).wait_for(timeout=LIMIT)
    assert page.locator("body").get_attribute("data-prompt") in states, transcript(page)


def wait_for_prompt(page):
    wait_for_state(page, "waits")


def transcript(page):
    return page.locator("#repl-out").text_content()


def enter(page, text):
    """Type a text by the keyboard, with Enter behind its last line; what stands behind it when the next prompt has come."""
    before, prompts = len(transcript(page)), int(page.locator("body").get_attribute("data-prompts"))
    line = page.locator("#repl-in")
    for number, part in enumerate(text.split("\n")):
        if number:
            line.press("Shift+Enter")
        line.press_sequentially(part)
    line.press("Enter")
    page.locator(f'body[data-prompt=waits]:not([data-prompts="{prompts}"])').wait_for()
    return transcript(page)[before:]


@pytest.mark.soak
@pytest.mark.parametrize("kind", KINDS)
def test_both_lectures_give_the_answers_of_the_terminal_without_a_network(visit):
    sys.path.append(str(ROOT / "tutorials"))
    from lectures import LECTURE_34, LECTURE_38

    page, cut = visit
    page.evaluate("navigator.serviceWorker.ready.then(() => true)")
    cut()
    page.reload()
    wait_for_prompt(page)
    packed = "fetch('pyodide/pyodide.asm.wasm.gz').then((answer) => answer.ok)"
    assert page.evaluate(packed), "a page that does not see its service worker yet asks for the packed file"
    for text in [*LECTURE_34, *LECTURE_38]:
        enter(page, text)
    assert PLACE.sub("", transcript(page)).splitlines() == PLACE.sub("", native_transcript()).splitlines()
    assert page.locator("#connection").get_attribute("data-state") == "open"
    assert page.locator("#modules").inner_text() != ""


@pytest.mark.soak
@pytest.mark.parametrize("kind", KINDS)
def test_the_prompt_has_a_history_ctrl_c_and_a_restart_that_keeps_files(visit):
    page, _ = visit
    assert enter(page, "(+ 1 2)").splitlines() == ["CL-USER> (+ 1 2)", "3"]
    line = page.locator("#repl-in")
    line.press("ArrowUp")
    assert line.inner_text() == "(+ 1 2)"
    line.fill("")
    for endless in ("(loop)", "(loop (sleep 1))", "(cpl:top-level (cpl:par (loop) (loop)))"):
        line.fill(endless)
        line.press("Enter")
        wait_for_state(page, "busy")
        line.press("Control+c")
        wait_for_prompt(page)
        assert transcript(page).endswith("; Interrupted.\n")
    enter(page, '(with-open-file (out "kept.lisp" :direction :output) (print :kept out))')
    enter(page, "(defvar *gone* 1)")
    page.locator("#repl-restart").click()
    wait_for_prompt(page)
    assert enter(page, '(with-open-file (in "kept.lisp") (read in))').splitlines()[-1] == ":KEPT"
    assert enter(page, "(boundp '*gone*)").splitlines()[-1] == "NIL"


@pytest.mark.soak
def test_a_browser_that_cannot_is_told_which_ones_can(made):
    with served(made) as (address, _), chromium() as browser:
        page = browser.new_page()
        page.add_init_script("delete WebAssembly.Suspending")
        page.goto(address)
        wait_for_state(page, "unfit")
        assert "Chrome and Edge can from version 137 on, and Firefox from 153 on." in " ".join(page.locator("#unfit").inner_text().split())
        assert not page.locator("#repl").is_visible()


@pytest.mark.soak
def test_the_site_is_of_one_origin_and_without_inline_code(made):
    index = (made / "index.html").read_text(encoding="utf-8")
    assert site.POLICY in index and "unsafe-inline" not in site.POLICY and "unsafe-eval" not in site.POLICY.replace("wasm-unsafe-eval", "")
    assert re.findall(r"<script(?![^>]* src=)|<style| on\w+=| style=", index) == []
    assert re.findall(r'(?:src|href)="(?:https?:)?//', index) == []
    listed = set(re.findall(r'^ "([^"]+)": "[0-9a-f]{16}"', (made / "offline.js").read_text(encoding="utf-8"), re.M))
    assert listed == {file.relative_to(made).as_posix() for file in made.rglob("*") if file.is_file()} - {"offline.js"}


@pytest.mark.soak
def test_the_first_visit_fetches_less_than_nine_megabytes_from_a_host_that_packs_nothing_or_only_texts(made):
    texts = (".js", ".mjs", ".css", ".html", ".json", ".svg")
    sizes = {file: (file.stat().st_size, len(gzip.compress(file.read_bytes()))) for file in made.rglob("*") if file.is_file()}
    assert sum(packed if file.suffix in texts else plain for file, (plain, packed) in sizes.items()) < 9_000_000
    assert sum(plain for plain, _ in sizes.values()) < 10_500_000


@pytest.mark.soak
def test_what_is_not_in_a_tab_is_told_and_what_programs_use_of_pythons_library_is_there(visit):
    page, _ = visit
    assert enter(page, '(py:call "statistics.mean" (list 1 2 3))').splitlines()[-1] == "2"
    for module in ("numpy", "http"):
        told = enter(page, f'(py:call "{module}.a" 1)')
        assert f"No module named '{module}': it is not part of this page." in told and left_out.ADVICE in told and "pip" not in told
        enter(page, "0")
    told = enter(page, '(ros-load:load-system "cram-location-costmap")')
    assert "cramhy_runtime.robot_world.costmaps is not there in a browser's tab: it needs MuJoCo or numpy" in told
    page.locator("#repl-in").fill("0")
    page.locator("#repl-in").press("Enter")
    wait_for_prompt(page)


# ---------------------------------------------------------------------------------------------------------------- the command


def test_a_folder_with_other_files_is_left_alone(tmp_path, capsys, monkeypatch):
    pyodide()
    (tmp_path / "thesis.tex").write_text("mine")
    assert cli.main(["browser", "--out", str(tmp_path)]) == 1
    assert capsys.readouterr().err == f"cramhy: The folder {tmp_path} is not empty, and holds no site of cramhy. Name another one.\n"
    assert [file.name for file in tmp_path.iterdir()] == ["thesis.tex"]


def test_without_pyodide_the_command_says_where_it_comes_from(tmp_path, capsys):
    assert cli.main(["browser", "--out", str(tmp_path / "out"), "--pyodide", str(tmp_path)]) == 1
    assert capsys.readouterr().err == (
        f"cramhy: There is no Pyodide in {tmp_path}: its package.json is missing, or is not that of the package pyodide. Fetch it with: "
        f"npm pack pyodide@{pyodide_files.VERSION}, and unpack that; or in a clone of cramhy: make pyodide.\n"
    )
    assert not (tmp_path / "out").exists()


def test_an_old_node_is_refused(monkeypatch):
    monkeypatch.setenv("CRAMHY_NODE", sys.executable)
    with pytest.raises(site.SiteError) as refused:
        site.find_node()
    assert str(refused.value) == (
        f"Pyodide compiles the packages in Node, and needs one from version 25 on. {sys.executable} is an older one, or is none. Name another "
        "one in the variable CRAMHY_NODE, or type in a clone of cramhy: make pyodide"
    )


def site_of(folder, **files):
    """A folder that looks like a site."""
    for name, text in {"worker.mjs": "1", "index.html": "the page", **files}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return folder


@pytest.mark.soak
def test_the_local_host_serves_the_site_and_nothing_else(tmp_path):
    (tmp_path / "secret").write_text("secret")
    folder = site_of(tmp_path / "site", **{"pyodide/a.wasm": "2"})
    with served(folder) as (address, _):
        assert urllib.request.urlopen(address).read() == b"the page"
        for name, kind in (("worker.mjs", "text/javascript"), ("pyodide/a.wasm", "application/wasm")):
            assert urllib.request.urlopen(address + name).headers["Content-Type"] == kind
        for wrong in ("nothing", "pyodide/", "../secret", "%2e%2e/secret"):
            with pytest.raises(urllib.error.HTTPError, match="404"):
                urllib.request.urlopen(address + wrong)


@pytest.mark.soak
def test_the_command_shows_a_site_until_ctrl_c(tmp_path):
    environment = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
    words = [sys.executable, "-m", "cramhy_runtime.cli", "browser", "--serve", str(site_of(tmp_path))]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment) as command:
        try:
            line = command.stdout.readline()
            (address,) = re.fullmatch(r"The course is at (http://127\.0\.0\.1:\d+/) until you press Ctrl-C\.\n", line).groups()
            assert urllib.request.urlopen(address).read() == b"the page"
        finally:
            command.send_signal(signal.SIGINT)
        assert command.communicate(timeout=60) == ("", "") and command.returncode == 0


def test_where_there_is_nothing_to_show_the_command_says_how_to_write_it(tmp_path, capsys):
    assert cli.main(["browser", "--serve", str(tmp_path)]) == 1
    assert capsys.readouterr().err == f"cramhy: There is no site of cramhy in {tmp_path}. Write one with: cramhy browser --out {tmp_path}\n"
    assert cli.main(["browser"]) == 2
    assert capsys.readouterr().err == "cramhy: Say what to do: --out FOLDER writes the site, and --serve FOLDER shows it.\n"


def test_a_port_that_is_taken_is_told(tmp_path, capsys):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert cli.main(["browser", "--serve", str(site_of(tmp_path)), "--port", str(port)]) == 1
    assert capsys.readouterr().err == f"cramhy: Port {port} cannot be used: Address already in use. Name another one, or none.\n"
