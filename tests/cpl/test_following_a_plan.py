"""Who follows a plan hears of each of its tasks that starts, and of each change of status of those that it observes."""

from cramhy_runtime import cpl, kernel
from cramhy_runtime.cpl.tree import finished_plans
from cramhy_runtime.cpl.tasks.task_observers import follow, unfollow
from cramhy_runtime.cpl.tasks.tasks import RECORD
from cramhy_runtime.lisp_core.dynamic import binding


class Follower:
    def __init__(self):
        self.started, self.changes = [], []

    def begins(self, task, name):
        follow(task, self.starts)

    def beside(self, task):
        follow(task, self.starts)

    def made(self, task):
        pass

    def ended(self, task, name):
        pass

    def starts(self, task):
        self.started.append(task)
        task.observers = [*(task.observers or ()), lambda task: self.changes.append((task.status.name, kernel.now()))]


def followed(body):
    follower = Follower()
    finished_plans.observe(follower)
    try:
        cpl.top_level(body)
    finally:
        finished_plans.observe_no_more(follower)
    return follower


def par():
    cpl.par(lambda: cpl.sleep(1), lambda: cpl.sleep(2))


def test_each_branch_is_heard_of_when_it_starts_and_when_it_changes():
    follower = followed(par)
    assert len(follower.started) == 2
    assert follower.changes == [("RUNNING", 0), ("RUNNING", 0), ("SUCCEEDED", 1), ("SUCCEEDED", 2)]


def test_who_joins_a_task_is_woken_beside_a_follower():
    def body():
        task = cpl.Task(lambda: cpl.sleep(3), "SLOW")
        task.execute()
        task.join()
        return kernel.now()

    assert [change for change in followed(body).changes] == [("RUNNING", 0), ("SUCCEEDED", 3)]


def test_a_plan_that_is_recorded_and_followed_keeps_its_record():
    with binding(RECORD, True):
        follower = followed(par)
    assert len(finished_plans.newest.value.record) == 3 and len(follower.started) == 3  # the root is in the record, too


def test_a_plan_can_be_followed_from_its_middle():
    follower = Follower()

    def body():
        def branch():
            cpl.sleep(1)
            root = cpl.current_task()
            while root.parent is not None:
                root = root.parent
            follow(root, follower.starts)
            cpl.sleep(1)

        cpl.par(branch, lambda: [cpl.sleep(1.5), par()])

    cpl.top_level(body)
    assert len(follower.started) == 2


def test_who_follows_no_more_hears_nothing():
    follower = Follower()

    def body():
        root = cpl.current_task()
        follow(root, follower.starts)
        par()
        unfollow(root, follower.starts)
        par()

    cpl.top_level(body)
    assert len(follower.started) == 2
