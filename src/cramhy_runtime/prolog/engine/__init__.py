"""The machine that proves goals, and the clauses that it knows.

Where the parts are: `machine` the trail and the stack of choices · `database` predicates and clauses · `fact_groups` · `relations`, `joins`
facts as tables · `services` what folders above do for it · `four_ports` what a tracer sees
· `depth_limit`, `failing_calls`, `source_positions`, `goal_text` for messages.
"""
