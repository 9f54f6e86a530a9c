"""The compiler of clauses: each predicate becomes Python functions.

Where the parts are: `compiler` · `clause_bodies` · `head_matching` · `list_building` lists that loops build · `variants`
predicates with known arguments · `generated_code` the text.
"""
