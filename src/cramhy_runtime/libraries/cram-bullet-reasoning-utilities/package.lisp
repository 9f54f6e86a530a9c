;;;; btr-utils: objects and the robot of the current world, by their names.

(defpackage #:cram-bullet-reasoning-utilities
  (:nicknames #:btr-utils #:bullet-reasoning-utilities)
  (:use #:common-lisp #:cram-bullet-reasoning #:cram-prolog #:cram-designators #:cram-utilities #:cram-robot-interfaces #:cram-tf)
  (:shadowing-import-from #:cram-bullet-reasoning #:object #:object-pose #:pose #:name #:item)
  (:export #:spawn-object #:kill-object #:kill-all-objects #:move-object #:object-instance #:object-pose #:object-exists #:item-exists
           #:respawn-object #:robot-name #:move-robot #:move-robot-away #:park-robot
           #:visualize-gripper #:reset-debug-window #:visualize-designator-costmaps #:assert-object-pose #:assert-object-pose-on
           #:scenario-objects-init-pose #:scenario-objects-default-color #:scenario-object-color #:scenario-object-shape
           #:scenario-object-extra-attributes))

(in-package #:cram-bullet-reasoning-utilities)
