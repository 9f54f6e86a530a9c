;;;; The robot as a whole: its name, frames and torso.

(in-package #:cram-pr2-description)

(def-fact-group pr2-metadata (robot robot-base-frame robot-odom-frame robot-torso-link-joint robot-description-file)

  (<- (robot pr2))

  (<- (robot-description-file pr2 "pr2.urdf"))

  (<- (robot-base-frame pr2 "base_footprint"))

  (<- (robot-odom-frame pr2 "odom_combined"))

  (<- (robot-torso-link-joint pr2 "torso_lift_link" "torso_lift_joint")))
