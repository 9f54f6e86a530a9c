"""The predicates that come with Prolog.

Where the parts are: `native_predicates` how predicates are defined in Python · `control` and, or, not, cut · `builtins` the others ·
`function_calls` functions called from Prolog · `rete`, `productions` facts that trigger handlers.
"""
