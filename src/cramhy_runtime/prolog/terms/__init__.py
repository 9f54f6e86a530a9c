"""Terms: variables, bindings and unification.

Where the parts are: `terms` · `deep_terms` terms that are too deep for recursion · `origins` where a term was written.
"""
