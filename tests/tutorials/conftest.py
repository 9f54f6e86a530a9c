"""Both languages in which the course is written."""

import pytest

from . import course


@pytest.fixture(params=["lisp", "hy"])
def language(request, monkeypatch):
    """The test runs with the package in Common Lisp, and with the one in plain Hy."""
    kind = {"lisp": course.Course, "hy": course.CourseInHy}[request.param]
    monkeypatch.setattr(course, "KIND", kind)
    with course.image_of(kind):
        yield request.param
