"""Prolog for Python: predicates, rules and queries in Python's notation.

Where the parts are: `ground` a kernel for queries · `spelling` names of Python in Lisp · `terms` names and variables · `predicates` Python
functions as predicates · `rules` fact groups and queries · `asserted_facts` facts that come and go.
"""
