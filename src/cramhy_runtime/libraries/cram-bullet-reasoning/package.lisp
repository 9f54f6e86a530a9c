;;;; cram-bullet-reasoning: worlds of robots and objects, and what can be said about them.

(defpackage #:cram-bullet-reasoning
  (:use #:common-lisp #:prolog #:cl-bullet #:cl-bullet-vis #:cut #:cram-robot-interfaces #:cl-transforms-stamped #:cram-tf)
  (:nicknames #:btr)
  (:shadow #:copy-object)
  (:shadowing-import-from #:cl-bullet #:pose #:points)
  (:export
   ;; worlds
   #:*current-bullet-world* #:bt-reasoning-world #:with-current-bullet-world #:copy-world #:simulate #:prolog-?w
   #:with-stored-world #:with-world #:with-copied-world #:get-state #:restore-world-state #:disabled-collision-objects
   ;; time
   #:timeline #:timeline-init #:timeline-advance #:timeline-lookup #:timeline-current-world-state #:make-event
   #:*current-timeline* #:with-timeline
   ;; objects
   #:object #:objects #:find-objects #:add-object #:remove-object #:item #:item-types #:name #:pose #:ensure-pose #:ensure-vector
   #:rigid-bodies #:rigid-body #:rigid-body-names
   #:aabb #:calculate-bb-dims #:item-dimensions #:bounding-box #:bounding-box-center #:bounding-box-dimensions
   #:contact-p #:find-all-contacts #:find-objects-in-contact #:link-contacts #:above-p #:below-p #:stable-p
   #:find-objects-above #:find-objects-below
   #:add-objects-to-mesh-list #:*mesh-files*
   ;; robots and furniture
   #:robot-object #:urdf #:joint-names #:joint-state #:joint-states #:link-names #:links #:link-pose #:set-robot-state-from-joints
   #:set-robot-state-from-tf #:attach-object #:detach-object #:detach-all-objects #:attached-objects #:object-attached
   #:get-robot-object #:get-robot-name #:get-environment-object #:robot-colliding-objects-without-attached #:calculate-pan-tilt
   ;; seeing
   #:*visibility-threshold* #:object-visible-p #:calculate-object-visibility #:occluding-objects
   ;; pictures
   #:save-picture #:with-movie
   #:*debug-window* #:add-debug-window #:add-vis-axis-object #:remove-vis-axis-object #:add-costmap-function-object
   #:add-costmap-sample-object #:clear-costmap-vis-object
   ;; predicates
   #:bullet-world #:clear-bullet-world #:assert #:retract #:%object #:object-pose #:object-pose-on #:item-type #:object-type #:object-bottom-pose
   #:contact #:object-not-in-collision #:stable #:stable-items #:above #:below #:supported-by #:supporting #:visible #:visible-from
   #:occluding-object #:link #:attached #:step #:simulate-realtime #:head-pointing-at #:execute #:open #:close #:debug-window
   #:debug-costmap #:poses-on #:n-poses-on #:random-poses-on #:desig-poses #:available-arms #:semantic-map #:container
   #:reachable #:point-reachable #:pose-reachable #:blocking #:valid-grasp #:object-grasp
   #:object-pose-different #:ik-solution-not-in-collision #:copied-world #:?w #:grasp #:side
   ;; more of worlds, events and robots
   #:world #:bt-reasoning-world-state #:merge-bounding-boxes #:invalidate-object #:make-object #:event #:holds-in-world
   #:make-joint-state-message #:open-object #:close-object #:set-articulated-object-joint-position #:obj-pose-on #:obj-poses-on
   ;; what a camera sees
   #:camera #:width #:height #:fov-y #:z-near #:z-far #:look-at-object-rotation
   #:object-visibility #:object-visibility-percentage #:object-visibility-occluding-objects
   ;; names of types of objects
   #:generic-cup #:mesh #:box #:static-plane #:sphere #:cylinder #:cone #:point-cloud #:cutlery #:fork #:knife #:mug #:plate #:mondamin #:pot
   #:bowl #:sugar-box #:apple #:orange #:cereal #:spatula #:pancake #:pancake-maker #:ros-household-object
   ;; what is not here: OpenGL, semantic maps, the database of household objects
   #:gl-execute-with-camera #:with-rendering-to-framebuffer #:render-to-framebuffer #:get-rendering-context #:read-pixelbuffer
   #:read-depthbuffer #:to-png-image #:flat-color-object-proxy #:drawable-list #:drawable-list-drawables #:make-drawable-list
   #:camera-transform #:semantic-map-object #:semantic-map-part #:semantic-map-part-type #:semantic-map-part-pose
   #:init-ros-object-database))

(in-package #:cram-bullet-reasoning)

(eval-when (:compile-toplevel :load-toplevel :execute)
  (loop for (name class) in '((bt-reasoning-world robot-world:world) (object robot-world:thing)
                              (item robot-world:item) (robot-object robot-world:machine))
        do (setf (find-class name) (find-class class)
                 (class-name (find-class class)) name)))
