(in-package :cup-demo)

(defun init-projection ()
  (def-fact-group costmap-metadata ()
    (<- (costmap:costmap-size 10 10))
    (<- (costmap:costmap-origin -5 -5))
    (<- (costmap:costmap-resolution 0.05))
    (<- (costmap:costmap-padding 0.2))
    (<- (costmap:costmap-in-reach-distance 0.6))
    (<- (costmap:costmap-reach-minimal-distance 0.2))
    (<- (costmap:orientation-samples 2))
    (<- (costmap:orientation-sample-step 0.1)))
  (setf btr-belief:*robot-parameter* "robot_description"
        btr-belief:*kitchen-parameter* "kitchen_description")
  (coe:clear-belief)
  (setf prolog:*break-on-lisp-errors* t
        ccl::*is-logging-enabled* nil
        ccl::*host* "'https://localhost'")
  (ccl::connect-to-cloud-logger)
  (btr:add-objects-to-mesh-list "cram_pr2_pick_place_demo"))

(roslisp-utilities:register-ros-init-function init-projection)
