// References of one module, apart and as a member of a chain.
#include "services/control/flight_reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace eciton::control {

using robot::Pose;
using robot::PoseMotion;
using robot::PoseReference;

namespace {

constexpr double slip_time_s = 0.3;
constexpr double slowing_time_s = 0.05;  // a module that docks at 0.2 m/s goes on by 2 cm

}  // namespace

FlightReference::FlightReference(const robot::Airframe& airframe, const FlightReferenceConfig& config)
    : airframe_(airframe), config_(config), joints_(airframe) {}

void FlightReference::hold(const Pose& X_WM) {
  kind_ = Kind::motion;
  motion_ = PoseMotion(X_WM);
}

robot::PoseMotion FlightReference::way_to(const Pose& X_WM, double speed_m_s, double start_s, double now_s) const {
  robot::TrajectoryLimits limits = config_.limits;
  limits.speed_m_s = speed_m_s > 0 ? speed_m_s : config_.speed_m_s;
  return {leading(now_s), X_WM, start_s, robot::SpeedProfile::trapezoid, limits};
}

robot::PoseSpline FlightReference::way_through(std::span<const Pose> waypoints, double speed_m_s, double start_s,
                                               double now_s) const {
  robot::TrajectoryLimits limits = config_.limits;
  limits.speed_m_s = speed_m_s > 0 ? speed_m_s : config_.speed_m_s;
  limits.rate_rad_s = config_.path_rate_rad_s;
  std::array<Pose, robot::waypoints_max> through;
  const std::size_t count = std::min(waypoints.size() + 1, through.size());
  const PoseReference from = leading(now_s);
  through[0] = {from.p_WM, from.R_WM};
  std::copy_n(waypoints.begin(), count - 1, through.begin() + 1);
  return {std::span<const Pose>(through).first(count), start_s, robot::SpeedProfile::trapezoid, limits};
}

void FlightReference::move(const Pose& X_WM, double speed_m_s, double start_s, double now_s) {
  motion_ = way_to(X_WM, speed_m_s, start_s, now_s);
  kind_ = Kind::motion;
}

void FlightReference::follow(std::span<const Pose> waypoints, double speed_m_s, double start_s, double now_s) {
  path_ = way_through(waypoints, speed_m_s, start_s, now_s);
  kind_ = Kind::path;
}

void FlightReference::track(const PoseReference& reference, double stamp_s) {
  if (kind_ != Kind::track) {
    const PoseReference from = leading(stamp_s);
    slip_p_ = from.p_WM - reference.p_WM;
    slip_v_ = from.v_WM - reference.v_WM;
    slip_phi_ = robot::log_so3(reference.R_WM.transpose() * from.R_WM);
    slip_s_ = stamp_s;
  }
  kind_ = Kind::track;
  tracked_ = reference;
  tracked_s_ = stamp_s;
}

void FlightReference::descend(double speed_m_s, double now_s) {
  // A tracked reference that is renewed by itself: it goes down until somebody sees the ground.
  const PoseReference from = leading(now_s);
  kind_ = Kind::descend;
  tracked_ = {};
  tracked_.p_WM = from.p_WM;
  tracked_.R_WM = from.R_WM;
  tracked_.v_WM = {0, 0, -speed_m_s};
  tracked_s_ = now_s;
}

void FlightReference::join(const ChainPlace& place, std::span<const double> joint_rad, const Pose& X_WM_base,
                           double now_s) {
  const PoseReference own = at(now_s);
  in_chain_ = true;
  place_ = place;
  joints_.reset(joint_rad, place.base);
  stand_by(own, place.own == place.base ? Pose{own.p_WM, own.R_WM} : X_WM_base, now_s);
}

void FlightReference::stand_by(const PoseReference& own, const Pose& X_WM_base, double now_s) {
  kind_ = Kind::motion;
  motion_ = PoseMotion(X_WM_base);
  offset_p_.setZero();
  offset_R_.setIdentity();
  slowing_v_.setZero();
  // Where the shared base puts this module, and where it is by its own lights: biases of its sensors, of the
  // others' and of the joints. Flown on with, so that joining moves nothing.
  const PoseReference shared = own_part(now_s);
  offset_p_ = motion_.at(now_s).R_WM.transpose() * (own.p_WM - shared.p_WM);
  offset_R_ = shared.R_WM.transpose() * own.R_WM;
  slowing_v_ = own.v_WM - shared.v_WM;
  joined_s_ = now_s;
}

void FlightReference::see_base(const Pose& X_WM_base, double now_s) {
  if (!in_chain_ || place_.own == place_.base || !at_rest(now_s) || !joints_.finished(now_s)) return;
  stand_by(at(now_s), X_WM_base, now_s);
}

void FlightReference::leave(double now_s) {
  const PoseReference own = at(now_s);
  in_chain_ = false;
  kind_ = Kind::motion;
  motion_ = PoseMotion::stop(own, now_s, config_.limits);
}

std::size_t FlightReference::members_on(const PoseReference& way, double t_s,
                                        std::span<PoseReference> members) const {
  if (!in_chain_) {
    members[0] = way;
    return 1;
  }
  std::array<robot::ScalarMotion, robot::coordinates_max> joints;
  const std::span part = std::span(joints).first(place_.members * airframe_.joints.size());
  joints_.at(t_s, part);
  robot::chain_references(airframe_, place_.base, way, part, members.first(place_.members));
  return place_.members;
}

void FlightReference::members_at(double now_s, std::span<PoseReference> members) const {
  members_on(leading(now_s), now_s, members);
}

PoseReference FlightReference::own_part(double now_s) const {
  std::array<PoseReference, robot::members_max> members;
  members_at(now_s, members);
  PoseReference own = members[place_.own];
  const PoseReference& base = members[place_.base];
  const robot::Vector3 &w = base.w_WM_M, turning = w.cross(offset_p_);
  own.p_WM += base.R_WM * offset_p_;
  own.v_WM += base.R_WM * turning;
  own.a_WM += base.R_WM * (base.alpha_WM_M.cross(offset_p_) + w.cross(turning));
  // A speed that the others do not share runs out, without a step in it or in the acceleration.
  const double s = std::max(0.0, now_s - joined_s_) / slowing_time_s, left = std::exp(-s);
  own.p_WM += slowing_v_ * slowing_time_s * (2 - (2 + s) * left);
  own.v_WM += slowing_v_ * (1 + s) * left;
  own.a_WM -= slowing_v_ * (s * left / slowing_time_s);
  own.R_WM = own.R_WM * offset_R_;
  own.w_WM_M = offset_R_.transpose() * own.w_WM_M;
  own.alpha_WM_M = offset_R_.transpose() * own.alpha_WM_M;
  return own;
}

PoseReference FlightReference::leading(double now_s) const {
  switch (kind_) {
    case Kind::motion:
      return motion_.at(now_s);
    case Kind::path:
      return path_.at(now_s);
    case Kind::descend: {
      PoseReference r = tracked_;
      r.p_WM += r.v_WM * (now_s - tracked_s_);
      return r;
    }
    case Kind::track: {
      PoseReference r = tracked_;
      const double ahead_s = std::clamp(now_s - tracked_s_, 0.0, config_.track_hold_s);
      r.p_WM += r.v_WM * ahead_s;
      r.R_WM = r.R_WM * robot::exp_so3(r.w_WM_M * ahead_s);
      if (ahead_s >= config_.track_hold_s) {
        r.v_WM.setZero();
        r.w_WM_M.setZero();
      }
      const double s = std::max(0.0, now_s - slip_s_) / slip_time_s, left = std::exp(-s);
      const robot::Vector3 rate = slip_v_ + slip_p_ / slip_time_s;
      r.p_WM += (slip_p_ + rate * (s * slip_time_s)) * left;
      r.v_WM += (slip_v_ - rate * s) * left;
      r.R_WM = r.R_WM * robot::exp_so3(slip_phi_ * left);
      return r;
    }
  }
  return {};
}

PoseReference FlightReference::at(double now_s) const { return in_chain_ ? own_part(now_s) : leading(now_s); }

bool FlightReference::arrived(double now_s) const {
  const bool there =
      (kind_ == Kind::motion && motion_.finished(now_s)) || (kind_ == Kind::path && path_.finished(now_s));
  return there && (!in_chain_ || joints_.finished(now_s));
}

}  // namespace eciton::control
