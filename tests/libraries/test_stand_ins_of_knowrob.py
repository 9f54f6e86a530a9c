"""``json-prolog`` and ``ccl``: applications call KnowRob and openEASE, which are not here. Nothing fails, and the session hears why, once."""

from __future__ import annotations

import pytest

from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

NO_KNOWROB = (
    "[(JSON-PROLOG) WARN] {}: There is no KnowRob here: queries to json_prolog have no answers, and it keeps nothing. This is said once.\n"
)
NO_CLOUD = (
    "[(CCL) WARN] {}: Nothing is logged to the cloud: there is no openEASE here. "
    "The episodes of this session keep what its plans did: see cram-execution-trace. This is said once.\n"
)
QUERIES = [
    '(json-prolog:prolog-simple "rdf_retractall(A,B,C,belief_state).")',
    '(json-prolog:prolog-simple-1 "member(A, [1])" :mode 1)',
    '(json-prolog:prolog \'("member" ?a (1 2)) :lispify t :package *package*)',
    '(json-prolog:prolog-1 \'("member" ?a (1 2)))',
    '(prolog:prolog \'(json-prolog:json-prolog ("member" ?a (1 2)) :lispify t))',
]
LOGGED = [
    "(ccl::connect-to-cloud-logger)",
    "(ccl::reset-logged-owl)",
    '(ccl::export-log-to-owl "log.owl")',
    "(ccl::export-belief-state-to-owl)",
    "(ccl::start-episode)",
    "(ccl::stop-episode)",
    '(ccl::send-prolog-query-1 "true")',
]


@pytest.fixture
def ask(session, capsys):
    """What a form answers, and what it printed, without the time of a line."""
    session.evaluate_text("(setf json-prolog::*told* nil ccl::*told* nil)")
    capsys.readouterr()

    def asked(form):
        value = prin1_to_string(session.evaluate_text(form)[0])
        printed = capsys.readouterr().out.lstrip()
        head, mark, rest = printed.partition("WARN] ")
        return value, f"{head}{mark}{{}}{rest[rest.index(':') :]}" if mark else printed

    return asked


@pytest.mark.parametrize("first", range(len(QUERIES)))
def test_a_query_has_no_answers_and_the_first_one_says_why(ask, first):
    assert ask(QUERIES[first]) == ("NIL", NO_KNOWROB)
    for query in QUERIES:
        assert ask(query) == ("NIL", "")


@pytest.mark.parametrize("first", range(len(LOGGED)))
def test_nothing_is_logged_and_the_first_call_says_so(ask, first):
    assert ask(LOGGED[first]) == ("NIL", NO_CLOUD)
    for call in LOGGED:
        assert ask(call) == ("NIL", "")


@pytest.mark.parametrize(
    ("form", "answer"),
    [
        ("(json-prolog:check-connection)", "NIL"),
        ("(json-prolog:wait-for-prolog-service 0.2)", "NIL"),
        ("(json-prolog:finish-query nil)", "NIL"),
        ("(json-prolog:with-type-atoms (json-prolog:init-type-atoms) 3)", "3"),
        ('(json-prolog:start-prolog-server "/prolog")', "NIL"),
        ("json-prolog:*service-namespace*", '"/json_prolog"'),
        ("(list ccl::*is-client-connected* ccl::*is-logging-enabled*)", "(NIL NIL)"),
        ("(setf ccl::*host* \"'https://localhost'\" ccl::*cert-path* \"'x'\" ccl::*api-key* \"'y'\")", "\"'y'\""),
    ],
)
def test_the_rest_answers_quietly(ask, form, answer):
    assert ask(form) == (answer, "")
