"""What plans and languages share: conses, symbols and packages, dynamic bindings, equality, conditions and restarts, generic functions.

It knows no reader, no printer, no FORMAT, no CLOS and no loader. What it wants done by whoever is installed above it (show an
object, format a message, ask the user), it asks of the typed ports in ``ports.py``, each of which has a plain Python answer; so plans
that are run without any language print and fail readably.
"""
