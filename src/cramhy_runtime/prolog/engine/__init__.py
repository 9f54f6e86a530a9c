"""The machine that proves goals, and the clauses that it knows.

Where the parts are: `machine` the trail and the stack of choices · `database` predicates and clauses · `fact_groups` · `relations`,
`list_shapes`, `joins` facts as tables · `services` functions of folders above · `four_ports` the events that a tracer sees
· `depth_limit`, `failing_calls`, `source_positions`, `goal_text` for messages.
"""
