;;;; btr-belief: the current world, as what is believed.

(defpackage #:cram-bullet-reasoning-belief-state
  (:nicknames #:btr-belief)
  (:use #:common-lisp #:cram-prolog)
  (:export #:*robot-urdf* #:*kitchen-urdf* #:*robot-parameter* #:*kitchen-parameter* #:*spawn-debug-window* #:*world-mode*
           #:setup-world-database #:set-tf-from-bullet #:update-bullet-transforms
           #:get-designator-object-name #:get-designator-object #:object-designator-name #:object-pose-in-frame))

(in-package #:cram-bullet-reasoning-belief-state)
