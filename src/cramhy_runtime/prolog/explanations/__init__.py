"""Explanations in words: why a query failed or succeeded.

Where the parts are: `explaining` the search for reasons · `failure_reasons` of built-in predicates · `undefined` unknown predicates ·
`explanations` the text.
"""
