;;;; pr2-proj-reasoning: try an action in the world before it is performed, and choose among its groundings the first that works.

(defpackage #:cram-pr2-projection-reasoning
  (:nicknames #:pr2-proj-reasoning)
  (:use #:common-lisp #:cram-prolog)
  (:export #:check-navigating-collisions #:check-picking-up-collisions #:check-placing-collisions
           #:check-environment-manipulation-collisions #:settle-on-place
           #:*projection-reasoning-enabled* #:with-projected-task-tree #:pick-best-parameters-by-distance))

(in-package #:cram-pr2-projection-reasoning)
