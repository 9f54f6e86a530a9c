"""Why a query failed or succeeded, in words.

Where the parts are: `explaining` the search for reasons · `failure_reasons` of built-in predicates · `undefined` unknown predicates ·
`explanations` the text.
"""
