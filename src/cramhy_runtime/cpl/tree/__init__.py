"""The task tree of a plan: the place of each task in it, its name there, and reports of the tree.

Where the parts are: `task_tree` the nodes · `tags` · `finished_plans` the newest ones · `tree_report` the tree as text.
"""
