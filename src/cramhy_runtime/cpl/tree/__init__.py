"""The tree of a plan: where each task stands in it, what it is called there, and how the tree is told.

Where the parts are: `task_tree` the nodes · `tags` · `finished_plans` the newest ones · `tree_report` the tree as text.
"""
