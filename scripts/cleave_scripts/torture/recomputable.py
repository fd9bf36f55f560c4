"""Which cells of steps.csv `verify` recomputes where all checksums suit, as results/README.md lists them, and how far a
number has to be off."""

OPTIONS = ("run_id partitioner refiner solver threads repeat_count gravity_m_per_s2 match_tolerance contact_cap "
           "skip_small_islands cold session repartition body_order mode advance steps scene_options schema_version "
           "problem_file scene seed step time_s friction dt_s cfm erp").split()
PARAMETERS = ("max_bodies tau_mr tau_mix max_growth edge_weight degree degree_scope as_printed sweeps predictor_sweeps "
              "max_iterations reuse_analysis quickstep_iterations ode_step_max_rows ode_friction mu "
              "friction_force_n").split()
SUMS = ("rows rows_bilateral rows_normal rows_friction contacts residual_m_per_s t_s_ms t_s_min_ms t_s_max_ms t_pr_ms "
        "t_s_analyze_ms t_s_predict_ms t_s_assemble_ms t_s_factor_local_ms t_s_form_interface_ms t_s_factor_interface_ms "
        "t_s_solve_ms t_s_check_ms t_s_refine_ms t_s_other_ms t_partition_ms t_refine_ms").split()
PROBLEM = "bodies islands problem_hash".split()
WORLD = ("contact_cap_hits t_collide_ms t_extract_ms t_predict_ms max_penetration_m potential_energy_j state_hash "
         "joint_drift_m last_body_z_m").split()
UNMEASURED = "ode_messages velocity_spread_m_per_s".split()
PARTS = ("parts_before parts max_part_bodies_before max_part_bodies cut_pairs_before cut_pairs interface_rows_before "
         "interface_rows interface_bodies_before interface_bodies interface_cover_bodies contiguous_before contiguous "
         "part_mass_ratio_max").split()
JUDGED = ("residual_m_per_s residual_bilateral_m_per_s residual_normal_m_per_s residual_friction_m_per_s residual_relative "
          "largest_free_velocity_m_per_s kinetic_energy_j energy_excess_j bound_mismatch friction_beyond_share "
          "part_condition_max").split()
STORED = "strategy kernel solution_hash".split()
OF_GOOD_ROWS = "status status_reason".split()

EVERYWHERE = {*OPTIONS, *PARAMETERS, *SUMS, *PROBLEM}
COLUMNS = {
    "record": EVERYWHERE,
    "replay": EVERYWHERE.union(WORLD, UNMEASURED, PARTS, JUDGED, STORED),
    "run": EVERYWHERE.union(WORLD),
    "run --record-motion": EVERYWHERE.union(WORLD),
}


def is_recomputable(command, column, row):
    """row: {column: cell} as it was."""
    return column in (OF_GOOD_ROWS if row["status"] == "ok" else ()) or column in COLUMNS[command]


def least_change(column, row):
    """A judged energy is held to a part of the kinetic energy."""
    return 1e-8 * max(1.0, float(row["kinetic_energy_j"])) if column in JUDGED else 1e-6
