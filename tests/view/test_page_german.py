"""The page in the language of the system: German, and English where there is no table."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from fake_session import task
from cramhy_runtime.view import page as page_of_view

STATIC = Path(page_of_view.__file__).with_name("static")
NAMES = {"cramhy", "×", "Lisp"}
"""What is the same in every language."""


def test_the_page_speaks_german_where_the_system_does(fake, visit):
    page = visit(fake.address, locale="de-AT")
    assert page.locator("html").get_attribute("lang") == "de"
    assert page.locator("#connection").inner_text() == "verbunden"
    assert page.locator("#pause").inner_text() in ("Pause", "Weiter")
    assert page.locator("#clear").get_attribute("title") == "/clear aufrufen: ein leeres Papier"
    assert page.locator("#pad button").first.get_attribute("aria-label") == "vorwärts"
    assert page.locator("#show-grid").inner_text() == "Gitter"
    assert page.locator("#empty").text_content() in ("", 'Noch keine Schildkröte. Es kommt eine mit (start-ros-node "turtle1").')
    fake.tasks(task("1", "TOP"), task("2", "CHILD", "1", "FAILED", ended=1.5, result="BUMP"))
    page.locator("#tasks-count", has_text="1 laufen, 1 beendet").wait_for()
    page.locator("#tasks", has_text="scheiterte mit BUMP").wait_for()


@pytest.mark.soak
def test_where_there_is_no_table_the_page_speaks_english(fake, visit):
    page = visit(fake.address, locale="fr-FR")
    assert page.locator("#connection").inner_text() == "connected"
    assert page.locator("html").get_attribute("lang") == "en"


def test_what_the_page_says_is_in_the_table_of_the_other_language():
    table = (STATIC / "german.js").read_text(encoding="utf-8")
    known = {json.loads(text) for text in re.findall(r'^  ("(?:[^"\\]|\\.)*"):', table, re.M)}
    scripts = "\n".join(file.read_text(encoding="utf-8") for file in STATIC.rglob("*.js") if file.name != "german.js")
    said = {json.loads(text) for text in re.findall(r'\bt\(\s*("(?:[^"\\]|\\.)+")', scripts)}
    markup = re.sub(r"<code>.*?</code>", "<code></code>", (STATIC / "index.html").read_text(encoding="utf-8"))
    said |= {" ".join(text.split()) for text in re.findall(r">([^<>]*[A-Za-z]{3}[^<>]*)<", markup)}
    said |= set(re.findall(r'(?:title|aria-label|aria-roledescription)="([^"]+)"', markup))
    assert said - known - NAMES == set() and len(said) > 100
    assert known - said == set()
