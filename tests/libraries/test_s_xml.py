"""S-XML: each form of ``s_xml.txt`` has the values that the library gives on SBCL, and what is better here."""

from pathlib import Path

from cramhy_runtime.lisp_core.classes import class_name
from cramhy_runtime.lisp_core.conditions import Condition

LINES = [line for line in (Path(__file__).parent / "s_xml.txt").read_text(encoding="utf-8").splitlines() if not line.startswith("; ")]


def test_forms_have_the_values_of_the_library(values):
    """One after the other, since some define functions that others call, and namespaces are counted."""
    different = []
    for form, answer in zip(LINES[::2], LINES[1::2], strict=True):
        try:
            told = f"=> {values(form, ' ; ')}"
        except Condition as problem:
            told = f"!! {class_name(type(problem)).name} {problem}"
        if " ".join(told.split()) != " ".join(answer.split()):
            different.append((form, answer, told))
    assert not different, "\n".join(map(repr, different))


def test_valid_texts_that_the_original_refuses_are_read(values):
    assert values("""(s-xml:parse-xml-string "<foo><?php echo 1 ?>x</foo >")""") == '(:|foo| "x")'


def test_print_xml_writes_to_standard_output(values):
    """The original writes the header there and the rest to the terminal."""
    assert values("""(with-output-to-string (*standard-output*)
                       (s-xml:print-xml '(:|foo| (:|b| "x")) :header "<?xml version='1.0'?>" :pretty t))""") == (
        "\"<?xml version='1.0'?>\n<foo>\n  <b>x</b>\n</foo>\""
    )


def test_names_of_any_package_are_printed(values):
    assert values("""(s-xml:print-xml-string '(p "at " ((a href "http://x.org") "home")))""") == (
        r'"<P>at <A HREF=\"http://x.org\">home</A></P>"'
    )


def test_a_namespace_makes_its_package(values):
    values("""(s-xml:register-namespace "http://x.org/made" "m" :s-xml-made)""")
    try:
        assert values("""(s-xml:parse-xml-string "<z:foo xmlns:z='http://x.org/made'/>")""") == (
            '((S-XML-MADE:|foo| :|xmlns:z| "http://x.org/made"))'
        )
    finally:
        values("(delete-package :s-xml-made)")


def texts_that_are_not_xml():
    yield "<nope:foo/>", 'namespace not found for prefix "nope".'
    yield "<foo>&lt x</foo>", "encountered incorrect entity near stream position 9."
    yield "<foo></bar>", "found <foo> not matched by </foo> but by <bar> near stream position 10."


def test_a_text_that_is_not_xml_is_an_error_of_the_parser(values):
    """So also where the original signals another error, or reads the whole text for the end of an entity."""
    for text, told in texts_that_are_not_xml():
        said = values(
            f"""(block nil
                  (handler-bind ((s-xml:xml-parser-error (lambda (e) (return (princ-to-string e)))))
                    (s-xml:parse-xml-string "{text}")))"""
        )
        assert said.replace("\\", "") == f'"XML parser {told}"'


def test_symbols_and_packages_that_are_not_there_can_be_refused(values):
    form = "(handler-case (let ((%s)) (s-xml:parse-xml-string %s)) (s-xml:xml-parser-error (e) (princ-to-string e)))"
    assert values(form % ("s-xml:*require-existing-symbols* t", '"<neverwasthere/>"')) == (
        r'"XML parser cannot find existing symbol for name \"neverwasthere\"."'
    )
    assert values(form % ("s-xml:*auto-create-namespace-packages* nil", """"<u:foo xmlns:u='http://x.org/u'/>\"""")) == (
        r'"XML parser cannot find package \"u\" for a namespace."'
    )


def test_what_is_in_no_tree_is_refused(values):
    assert values("""(handler-case (s-xml:print-xml-string '(:|foo| nil)) (error (e) (princ-to-string e)))""") == (
        '"Input not recognized as LXML NIL"'
    )


def test_a_file_is_parsed(values, tmp_path):
    (tmp_path / "a.xml").write_text("<?xml version='1.0'?>\n<a b='ä'>\n <c/>\n</a>\n", encoding="utf-8")
    assert values(f'(s-xml:parse-xml-file "{tmp_path}/a.xml")') == '((:|a| :|b| "ä") :|c|)'
    assert values(f'(handler-case (s-xml:parse-xml-file "{tmp_path}/none.xml") (file-error () :missing))') == ":MISSING"
