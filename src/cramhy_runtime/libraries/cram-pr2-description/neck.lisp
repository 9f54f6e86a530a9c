;;;; The head: cameras, of which the first that the robot has is its eye, and the two joints of the neck.

(in-package #:cram-pr2-description)

(def-fact-group pr2-neck (camera-frame camera-minimal-height camera-maximal-height robot-pan-tilt-links robot-pan-tilt-joints
                          robot-neck-parking-joint-states robot-neck-looking-joint-states)

  (<- (camera-frame pr2 "head_mount_kinect_rgb_optical_frame"))
  (<- (camera-frame pr2 "openni_rgb_optical_frame"))
  (<- (camera-frame pr2 "narrow_stereo_optical_frame"))

  (<- (camera-minimal-height pr2 1.27d0))
  (<- (camera-maximal-height pr2 1.60d0))

  (<- (robot-pan-tilt-links pr2 "head_pan_link" "head_tilt_link"))
  (<- (robot-pan-tilt-joints pr2 "head_pan_joint" "head_tilt_joint"))

  (<- (robot-neck-parking-joint-states pr2 (("head_pan_joint" 0.0d0) ("head_tilt_joint" 0.0d0))))
  (<- (robot-neck-looking-joint-states pr2 (("head_pan_joint" 0.0d0) ("head_tilt_joint" 0.0d0)))))
