// The papers' plots, each from the series of one experiment. A series that was not recorded leaves its plot empty.
#pragma once

#include <vector>

#include "deploy/experiments/experiment.hpp"

namespace eciton::deploy {

/// Fig. S1 B to D: time_s, position_error_m, attitude_error_rad, speed_m_s, [xyz]_m, [xyz]_reference_m.
std::vector<report::Plot> tracking_plots(const Figures& figures);

/// Fig. 5 B to E. Per trial: success, time_s, recoveries. Flattened over trials: approach_trial, approach_time_s (0:
/// latched), approach_axial_m, approach_radial_m, approach_attitude_rad; assembled_position_error_m,
/// assembled_contact_force_N_estimated, assembled_contact_torque_Nm_estimated.
std::vector<report::Plot> docking_plots(const Figures& figures);

/// Fig. 4 B to E: time_s, contact_force_N_<link>[_estimated], contact_torque_Nm_<link>[_estimated],
/// base_position_error_m, base_attitude_error_rad, joint_rad_<k>, joint_torque_Nm_<k>, mark_s (T1, T2, …).
std::vector<report::Plot> morph_plots(const Figures& figures);

/// Fig. S2 B to D: time_s, joint_rad, contact_force_N_<law>, contact_torque_Nm_<law>, [mark_s: T0].
std::vector<report::Plot> ablation_plots(const Figures& figures);

/// Fig. S3: modules, position_error_m_<law>, attitude_error_rad_<law>, convergence_s_<law> (60 and more: none in 60
/// s); flattened error_modules, error_position_m, error_attitude_rad.
std::vector<report::Plot> scaling_plots(const Figures& figures);

/// Every series as long as time_s, together by unit.
std::vector<report::Plot> series_plots(const Figures& figures);

}  // namespace eciton::deploy
