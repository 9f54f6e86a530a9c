"""The laws whose text runs in Lisp only, by the reason why."""

REASONS = {
    "the message, or what is looked at, shows the form as Lisp has it": """
        test_a_broken_clause_is_refused_when_the_policy_is_compiled
        test_a_clause_of_another_shape_is_refused_when_the_form_is_compiled
        test_a_watcher_that_never_leaves_waits_for_ever_which_is_told
        test_an_exit_out_of_a_branch_is_an_error_that_says_what_to_do
        test_the_last_of_two_clauses_for_a_type_counts_and_a_parameter_list_may_have_any_shape
        test_the_requests_are_generic_functions_and_say_what_they_cannot_be_called_with
        test_the_wrong_use_of_a_policy_says_what_is_wrong
        test_two_runs_of_one_name_at_a_time_would_share_a_tree_and_the_second_is_refused
    """,
    "a special variable of the Lisp package is read or bound, which Hy does not have": """
        test_an_init_function_gets_the_task_its_parent_and_the_value_that_the_parent_sees
        test_assigning_a_task_variable_in_a_child_is_seen_by_later_children_of_it_only
        test_define_task_variable_has_all_its_keywords
        test_the_functions_for_tags_give_the_active_ones_and_unknown_tags_change_nothing
        test_the_hooks_of_a_top_level_run_in_order_around_its_body_however_it_ends
        test_the_lists_of_statuses_and_the_type
        test_the_status_is_a_value_fluent_named_after_the_task
        test_what_the_setup_hook_binds_reaches_the_plan_if_it_is_a_task_variable
    """,
    "functions of Lisp work on fluents as on values, where Hy uses Python's operators": """
        test_a_cached_net_that_stays_the_same_runs_no_callback
        test_a_callback_may_read_assign_and_register_on_its_own_fluent
        test_a_callback_name_is_taken_until_the_callback_is_removed
        test_a_fluent_inside_of_a_list_is_not_seen
        test_a_hundred_thousand_nets_that_nobody_holds_cost_an_input_nothing_that_never_pulses
        test_a_net_that_cannot_be_cached_runs_its_callbacks_at_every_pulse
        test_a_net_that_is_held_survives_and_so_do_those_below_it
        test_apply_with_a_predicate_and_a_list_of_fluents_follows_the_elements
        test_callbacks_and_all_nets_below_are_up_to_date_when_the_assignment_returns
        test_making_a_net_computes_it_once_if_all_inputs_are_cacheable_and_else_not_at_all
        test_peeking_a_net_consumes_nothing_of_all_that_its_function_reads
        test_value_changed_is_true_once_after_a_change_and_never_for_a_mere_pulse
        test_who_waits_for_a_net_keeps_it
    """,
    "a form of Common Lisp is in it that `lisp_to_hy` writes in another way": """
        test_a_condition_of_another_family_reaches_the_parents_handlers_and_leaves_top_level_as_itself
        test_a_limit_that_can_end_nothing_does_not_hide_a_deadlock
        test_a_policy_condition_reaches_the_handlers_of_parents
        test_a_renamed_pattern_still_matches_what_the_pattern_matches
        test_a_segment_variable_matches_but_is_not_bound_in_the_body
        test_a_timeout_ends_a_longer_body_and_leaves_a_shorter_one_alone
        test_all_children_have_started_before_the_first_decision
        test_an_endless_loop_without_waits_can_be_suspended_and_evaporated
        test_assertions_about_exits_show_the_forms
        test_cleanup_that_a_failure_began_is_not_cut_short_by_the_failure_of_a_sibling
        test_counters_around_stay_visible_and_the_inner_of_one_name_hides_the_outer
        test_error_and_plan_failure_do_not_catch_each_other
        test_evaporating_a_child_leaves_the_parent_running
        test_filter_task_tree_copies_what_satisfies_the_predicate_and_drops_the_rest_with_all_below
        test_leaving_an_on_suspension_form_by_a_non_local_exit_is_an_error_of_the_task
        test_par_returns_when_all_have_ended_with_the_values_of_its_first_form
        test_seq_and_a_sequence_of_tags_are_strictly_sequential
        test_sleep_takes_any_real_and_returns_nil
        test_substituting_the_bindings_of_a_match_into_its_pattern_rebuilds_the_data
        test_suspending_a_child_leaves_its_parent_running
        test_tags_in_one_with_tags_lie_side_by_side_and_an_inner_with_tags_lies_in_its_tag
        test_tags_that_macros_make_are_found_global_and_local_ones
        test_task_and_toplevel_task_have_a_common_parent_and_are_not_of_each_others_type
        test_the_first_goal_body_that_matches_wins_and_redefining_one_keeps_its_place
        test_what_led_into_the_cleanup_goes_on_when_the_limit_has_ended_it
        test_when_a_status_is_dead_the_result_is_final
    """,
}

NOT_IN_HY = {name: reason for reason, names in REASONS.items() for name in names.split()}
