"""Tasks: how they wait, stop, go on and end, and how a form runs branches.

Where the parts are: `tasks` a task and its status · `pausing`, `waiting`, `suspension` how it stops · `ending` how it is ended ·
`branches` which branch decides a form, and how the others die · `parallel_children` ``with-parallel-childs`` · `timeouts`,
`block_order`, `attempts`, `delegated_work` pieces of a task · `task_readers`, `task_observers` questions about tasks.
"""
