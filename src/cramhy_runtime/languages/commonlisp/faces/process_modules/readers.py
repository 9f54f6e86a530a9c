"""Reader functions of process modules, under the Lisp names of their slots; each gives a fluent."""


def input_(module):
    """The fluent of the designator that is processed now."""
    return module.input


def cancel(module):
    """The fluent that cancels what is processed now when it becomes true."""
    return module.cancel


def caller(module):
    """The fluent of the task that sent the current input."""
    return module.caller
