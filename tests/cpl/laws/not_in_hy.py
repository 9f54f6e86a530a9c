"""The laws whose text runs in Lisp only, by the reason why.

A text with a form that plain Hy does not have is left out by `lisp_to_hy` itself. Of 261 laws in Lisp text 184 run in Hy, on both back ends.
"""

REASONS = {
    "the message, or what is looked at, shows the form, its place or its names as Lisp has them": """
        test_a_broken_clause_is_refused_when_the_policy_is_compiled
        test_a_clause_of_another_shape_is_refused_when_the_form_is_compiled
        test_a_segment_variable_matches_but_is_not_bound_in_the_body
        test_a_task_tree_node_prints_its_path_and_count_on_lines_of_their_own_if_one_is_too_short
        test_a_watcher_that_never_leaves_waits_for_ever_which_is_told
        test_an_init_function_gets_the_task_its_parent_and_the_value_that_the_parent_sees
        test_counters_around_stay_visible_and_the_inner_of_one_name_hides_the_outer
        test_define_task_variable_has_all_its_keywords
        test_seq_and_a_sequence_of_tags_are_strictly_sequential
        test_the_first_goal_body_that_matches_wins_and_redefining_one_keeps_its_place
        test_the_functions_for_tags_give_the_active_ones_and_unknown_tags_change_nothing
        test_the_last_of_two_clauses_for_a_type_counts_and_a_parameter_list_may_have_any_shape
        test_the_old_names_of_plan_definitions_work_and_are_warned_of_at_their_place
        test_the_requests_are_generic_functions_and_say_what_they_cannot_be_called_with
        test_the_warning_says_whose_cleanup_waited_for_what_and_where
        test_the_wrong_use_of_a_policy_says_what_is_wrong
        test_two_runs_of_one_name_at_a_time_would_share_a_tree_and_the_second_is_refused
    """,
    "a condition of Lisp is asked for its name, and a class of Hy has another": """
        test_a_condition_of_another_family_reaches_the_parents_handlers_and_leaves_top_level_as_itself
    """,
    "there is no `block`, no `return-from` and no complex number of Lisp in Hy": """
        test_an_exit_out_of_a_branch_is_an_error_that_says_what_to_do
        test_assertions_about_exits_show_the_forms
        test_leaving_an_on_suspension_form_by_a_non_local_exit_is_an_error_of_the_task
        test_sleep_takes_any_real_and_returns_nil
    """,
    "a variable is read or changed as a special variable of the Lisp package": """
        test_a_hundred_thousand_nets_that_nobody_holds_cost_an_input_nothing_that_never_pulses
        test_a_parameter_reads_as_its_value_and_is_a_place
        test_the_hooks_of_a_top_level_run_in_order_around_its_body_however_it_ends
    """,
    "functions of Lisp work on fluents as on values, where Hy uses Python's operators, and asks a fluent for its `value`": """
        test_a_cached_net_that_stays_the_same_runs_no_callback
        test_a_callback_may_read_assign_and_register_on_its_own_fluent
        test_a_callback_name_is_taken_until_the_callback_is_removed
        test_a_fluent_inside_of_a_list_is_not_seen
        test_a_net_that_cannot_be_cached_runs_its_callbacks_at_every_pulse
        test_a_net_that_is_held_survives_and_so_do_those_below_it
        test_a_true_value_releases_all_who_wait_for_it_or_for_a_net_that_became_true
        test_apply_with_a_predicate_and_a_list_of_fluents_follows_the_elements
        test_callbacks_and_all_nets_below_are_up_to_date_when_the_assignment_returns
        test_peeking_a_net_consumes_nothing_of_all_that_its_function_reads
        test_the_status_is_a_value_fluent_named_after_the_task
        test_value_changed_is_true_once_after_a_change_and_never_for_a_mere_pulse
    """,
    "the arguments behind `&rest` and `&key` are Python's, or a macro makes its form of Lisp's lists": """
        test_a_plan_function_keeps_its_documentation_declarations_and_parameters
        test_making_a_net_computes_it_once_if_all_inputs_are_cacheable_and_else_not_at_all
        test_tags_that_macros_make_are_found_global_and_local_ones
        test_tv_closure_binds_the_task_variables_as_they_are_seen_when_it_is_made
    """,
    "a form of Common Lisp is in it that `lisp_to_hy` cannot write yet": """
        test_a_form_whose_later_branch_cannot_be_started_ends_the_earlier_ones
        test_a_step_whose_predecessor_fails_never_runs_its_body
        test_filter_task_tree_copies_what_satisfies_the_predicate_and_drops_the_rest_with_all_below
        test_the_limit_ends_the_wait_with_a_warning
        test_what_led_into_the_cleanup_goes_on_when_the_limit_has_ended_it
        test_who_waits_for_a_net_keeps_it
    """,
}

NOT_IN_HY = {name: reason for reason, names in REASONS.items() for name in names.split()}
