"""What section 17 of the reference warns of, where no invariant says it: traps 6, 16, 17, 34, 39, 43."""

import pytest

from cramhy_runtime import cpl, kernel


def test_a_bare_except_that_swallows_an_evaporation_gets_it_again_where_it_waits_next():
    """Trap 6. Evaporation is a BaseException: ``except Exception`` does not see it, a bare ``except`` does not get rid of it."""
    order = []

    def eats():
        try:
            cpl.sleep(1000)
        except:  # noqa: E722
            order.append("eaten")
        cpl.sleep(1000)
        order.append("never reached")

    def body():
        task = cpl.Task(eats).execute()
        cpl.sleep(1)
        cpl.evaporate(task)
        return task.status

    assert cpl.top_level(body) is cpl.EVAPORATED and order == ["eaten"] and kernel.now() == 1


def test_a_cleanup_form_that_leaves_by_an_exit_of_its_own_does_not_escape_the_evaporation(lisp):
    assert (
        lisp("""
        (let ((order nil))
          (top-level
            (pursue
              (progn
                (block escape
                  (unwind-protect (sleep 1000)
                    (push :cleanup order)
                    (return-from escape nil)))
                (push :on order)
                (sleep 1000)
                (push :never order))
              (sleep 1)))
          (reverse order))""")
        == "(:CLEANUP :ON)"
    )


def test_except_exception_does_not_see_an_evaporation():
    seen = []

    def careless():
        while True:
            try:
                cpl.sleep(1000)
            except Exception as exception:
                seen.append(exception)

    cpl.top_level(lambda: cpl.pursue(careless, lambda: cpl.sleep(1)))
    assert seen == [] and kernel.now() == 1


@pytest.mark.law(62)
def test_dynamic_bindings_of_the_caller_are_not_seen_in_a_plan_function(lisp):
    """Traps 16 and 17: a plan function runs in a task of its own, on a stack of its own."""
    assert (
        lisp("""
        (defvar *x* :global)
        (define-task-variable *tv* :global)
        (def-cram-function f () (list *x* *tv* (later (parent-task (current-task))) (typep (current-task) 'task)))
        (let ((*tv* :bound)) (top-level (let ((*x* :bound)) (f))))""")
        == "(:GLOBAL :BOUND :RUNNING T)"
    )


@pytest.mark.soak(all_but=4)
@pytest.mark.law(97)
@pytest.mark.parametrize("seed", [None, 1, 2, 3])
def test_branches_begin_in_the_order_in_which_they_are_written_with_any_seed(request, seed):
    """Trap 34."""
    kernel.start(backend=request.getfixturevalue("fresh_kernel").backend.name, seed=seed)
    begun = []
    cpl.top_level(lambda: cpl.par(*[lambda n=n: (begun.append(n), cpl.sleep(1)) for n in range(20)]))
    assert begun == list(range(20))


def test_a_task_that_waits_is_not_woken_while_nothing_happens_that_it_waits_for():
    """Trap 39: nobody polls. A hundred tasks that wait take no turns, however much time passes and other fluents change."""
    never, other = cpl.make_fluent(), cpl.make_fluent(value=0)

    def busy():
        for _ in range(100):
            cpl.sleep(1)
            other.value += 1

    tickets = []

    def body():
        tasks = [cpl.Task(lambda: cpl.wait_for(never)).execute() for _ in range(100)]
        kernel.yield_()
        before = [task.kernel_task.ticket for task in tasks]
        busy()
        tickets.extend((before, [task.kernel_task.ticket for task in tasks]))

    cpl.top_level(body)
    assert tickets[0] == tickets[1] and kernel.now() == 100


def test_two_executions_of_one_form_have_two_names(lisp):
    """Trap 43; in the original the number belongs to the form."""
    assert (
        lisp("""
        (flet ((run () (top-level (par (name (current-task))))))
          (let ((first (run)) (second (run)))
            (list (string= first second) (mismatch first second :end1 (length "[PAR-CHILD-#1/1]") :end2 (length "[PAR-CHILD-#1/1]")))))
        """)
        == "(NIL NIL)"
    )


def test_an_exit_out_of_a_branch_is_an_error_that_says_what_to_do(lisp):
    """Trap 36."""
    for leave in ("(return-from out 1)", "(go out)"):
        text = f"(top-level (block out (tagbody (par (sleep 1) {leave}) out)))"
        assert "A branch of a plan tried to leave a form around it" in lisp.error(text)
    assert lisp.error("(top-level (catch :out (par (sleep 1) (throw :out 1))))") == "attempt to THROW to a tag that does not exist: :OUT"
