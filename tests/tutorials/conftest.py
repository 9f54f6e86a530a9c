"""The course's package works in this process; other rooms' tests find the image as it was."""

import pytest
from course_in_process import course_in_process


@pytest.fixture(scope="module", autouse=True)
def image_afterwards():
    with course_in_process():
        yield
