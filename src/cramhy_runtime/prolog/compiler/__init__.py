"""The compiler of clauses: each predicate becomes Python functions.

Where the parts are: `compiler` · `clause_bodies` · `head_matching` · `list_building` lists from front to back · `generated_code` the text.
"""
