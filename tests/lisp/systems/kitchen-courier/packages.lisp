;;;; Packages.  COURIER-WORLD and COURIER-COSTMAP both export SAMPLE, VALUE-AT and CELL; the plan package takes one side of
;;;; each quarrel by shadowing, and has a STEP, a SEARCH and a PHASE that are not those of Common Lisp or of others.

(in-package #:cl-user)

(defpackage #:courier-util
  (:use #:common-lisp)
  (:nicknames #:cu)
  (:documentation "What every plan package ends up writing once more.")
  (:export #:with-gensyms #:once-only #:if-let #:when-let #:while #:until #:define-enumeration #:define-collector
           #:collecting #:collect-into #:defmemo #:clear-memo #:-> #:it #:aif #:awhen #:acond #:define-anaphoric
           #:appendf #:maxf #:toggle #:do-plist #:named-lambda #:compose #:curry
           ;; strings
           #:split #:join #:pad #:kebab-to-camel #:camel-to-kebab #:read-pairs #:caesar #:table #:wrap-words #:string-case
           ;; queue
           #:queue #:make-queue #:queue-push #:queue-pop #:queue-empty-p #:queue-size #:do-queue #:queue-peek
           ;; chance
           #:with-chance #:chance #:roll #:pick #:shuffled #:*chance*))

(defpackage #:courier-world
  (:use #:common-lisp #:courier-util)
  (:shadow #:position #:space)
  (:export #:point #:make-point #:point-x #:point-y #:copy-point #:point-p #:pose #:make-pose #:pose-x #:pose-y #:pose-heading
           #:pose-p #:distance #:normalize-angle #:between #:heading-to #:fraction #:coordinate #:angle #:polar
           ;; objects
           #:thing #:name #:position #:weight #:movable #:container #:fragile #:openable #:contents #:capacity #:surface
           #:appliance #:crockery #:food #:cup #:plate #:bowl #:milk #:cereal #:fridge #:dishwasher #:table-top #:cupboard
           #:open-p #:describe-briefly #:hazards #:total-weight #:volume #:perishable #:shelf-life #:clean-p #:grasps
           ;; model
           #:world #:make-world #:*world* #:with-world #:object-named #:add-object #:remove-object #:do-objects #:objects-of
           #:where-is #:put-into #:take-out #:sample #:value-at #:cell #:snapshot #:difference #:location-of #:note #:world-clock
           #:advance-clock #:unknown-object #:unknown-object-name #:suggestions #:container-full #:holds
           #:define-kitchen #:build-kitchen #:breakfast #:*kitchens*
           ;; what is called so in the kitchen
           #:red-cup #:blue-cup #:my-bowl #:flakes #:old-milk #:new-milk #:blue-plate #:plate-1 #:sink))

(defpackage #:courier-costmap
  (:use #:common-lisp #:courier-util)
  (:import-from #:courier-world #:point #:make-point #:point-x #:point-y #:distance)
  (:export #:costmap #:make-costmap #:map-width #:map-height #:value-at #:cell #:sample #:merge-costmaps #:draw #:define-costmap
           #:neighbours #:blocked-p #:costmap-cells #:do-cells #:gaussian #:normalize #:hottest #:row #:block-cells))

(defpackage #:courier-plans
  (:use #:common-lisp #:courier-util #:courier-world #:courier-costmap)
  (:shadow #:step #:search)
  (:shadowing-import-from #:courier-costmap #:sample #:value-at #:cell)
  (:shadowing-import-from #:courier-world #:position)
  (:export #:match #:substitute-bindings #:variable-p #:find-path #:path-cost #:defoperator #:operator #:apply-operator
           #:applicable-p #:define-task #:plan-for #:no-plan #:no-plan-task #:state #:facts
           ;; execution
           #:courier-failure #:grasp-failed #:navigation-failed #:object-slipped #:robot-exhausted #:failure-object #:attempts
           #:with-recovery #:retry #:retry-with #:skip-task #:give-up #:use-other-arm
           #:event-log #:log-event #:events #:with-event-log #:*event-log* #:count-events #:event-kind
           #:robot #:arm #:perform #:battery #:make-robot #:*robot* #:execute #:execute-plan #:with-faults
           #:main #:report #:statistics))
