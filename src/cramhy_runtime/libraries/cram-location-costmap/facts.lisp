;;;; Costmaps in Prolog: the predicates that rules about designators use. The settings, from COSTMAP-SIZE to ORIENTATION-SAMPLE-STEP, are
;;;; facts that the application states. Nothing is said of them here, so that it needs no list of extendable predicates for them.

(in-package #:cram-location-costmap)

(def-fact-group location-costmap-designators (desig-costmap)
  (<- (desig-costmap ?designator ?costmap) (fail)))

(defun costmap-metadata ()
  "The initargs of a costmap by the facts of the application: (:width w :height h :origin-x x :origin-y y :resolution r). In the branch
devel of CRAM the facts name the environment first, as in (costmap-size :iai-kitchen 12 12)."
  (flet ((fact (name &rest variables)
           (let ((solution (or (lazy-car (prolog (cons name variables)))
                               (fact-of-environment name variables))))
             (unless solution
               (error "No fact tells the ~(~A~). An application says it in a fact group: ~
                       (def-fact-group costmap-metadata (costmap-size costmap-origin costmap-resolution) ~
                       (<- (costmap-size 12 12)) (<- (costmap-origin -6 -6)) (<- (costmap-resolution 0.05)))"
                      name))
             (mapcar (lambda (variable) (var-value variable solution)) variables))))
    (destructuring-bind (width height) (fact 'costmap-size '?width '?height)
      (destructuring-bind (origin-x origin-y) (fact 'costmap-origin '?x '?y)
        (%check-metadata width height origin-x origin-y (first (fact 'costmap-resolution '?resolution)))))))

(defun fact-of-environment (name variables)
  "The first solution of the goal NAME about the environment that CRAM-ROBOT-INTERFACES knows, or about any."
  (let* ((asked (and (find-package '#:cram-robot-interfaces) (find-symbol "GET-ENVIRONMENT-NAME" '#:cram-robot-interfaces)))
         (environment (or (and asked (fboundp asked) (ignore-errors (funcall asked))) '?_))
         (solution (lazy-car (prolog (list* name environment variables)))))
    (when solution (setf *height-tolerance* 0.01))
    solution))

(defun new-costmap ()
  (apply #'make-instance 'location-costmap (costmap-metadata)))

(defun made-by (form)
  "What FORM, a function's name with its arguments, which are not evaluated, gives."
  (apply (first form) (rest form)))

(defun add-function (name form costmap)
  (register-cost-function costmap (made-by form) name))

(defun add-heightmap (map costmap)
  (register-height-generator costmap (lambda (x y)
                                       (when (in-grid-p map x y) (list (2d-value-map-lookup map x y))))))

(defun in-grid-p (grid x y)
  (and (<= 0 (- x (origin-x grid)) (width grid)) (<= 0 (- y (origin-y grid)) (height grid))))

(defun add-height-generator (form costmap)
  (register-height-generator costmap (made-by form)))

(defun add-cached-height-generator (form costmap)
  (register-height-generator costmap (%cached costmap (made-by form))))

(defun add-orientation-generator (form costmap)
  (register-orientation-generator costmap (made-by form)))

(defun add-cached-orientation-generator (form costmap)
  (register-orientation-generator costmap (%cached costmap (made-by form))))

(defun fluent-value (name)
  (cram-language:value (symbol-value name)))

(def-fact-group location-costmap-predicates ()
  (<- (costmap ?costmap)
    (bound ?costmap)
    (lisp-type ?costmap location-costmap))

  (<- (costmap ?costmap)
    (not (bound ?costmap))
    (lisp-fun new-costmap ?costmap))

  (<- (costmap-add-function ?name ?function ?costmap)
    (lisp-fun add-function ?name ?function ?costmap ?_))

  (<- (costmap-add-heightmap ?map ?costmap)
    (lisp-fun add-heightmap ?map ?costmap ?_))

  (<- (costmap-add-height-generator ?function ?costmap)
    (lisp-fun add-height-generator ?function ?costmap ?_))

  (<- (costmap-add-cached-height-generator ?function ?costmap)
    (lisp-fun add-cached-height-generator ?function ?costmap ?_))

  (<- (costmap-add-orientation-generator ?function ?costmap)
    (lisp-fun add-orientation-generator ?function ?costmap ?_))

  (<- (costmap-add-cached-orientation-generator ?function ?costmap)
    (lisp-fun add-cached-orientation-generator ?function ?costmap ?_))

  (<- (merged-desig-costmap ?designator ?costmap)
    (bagof ?part (desig-costmap ?designator ?part) ?parts)
    (lisp-fun merge-costmaps ?parts ?costmap))

  (<- (costmap-samples ?costmap ?solutions)
    (lisp-fun costmap-samples ?costmap ?solutions))

  (<- (global-fluent-value ?name ?value)
    (lisp-fun fluent-value ?name ?value))

  (<- (occupancy-grid ?message ?grid)
    (lisp-fun occupancy-grid-msg->occupancy-grid ?message ?grid))

  (<- (occupancy-grid ?message ?grid (padding ?padding))
    (lisp-fun occupancy-grid-msg->occupancy-grid ?message :padding ?padding ?grid))

  (<- (inverted-occupancy-grid ?message ?grid)
    (lisp-fun occupancy-grid-msg->occupancy-grid ?message :invert t ?grid))

  (<- (inverted-occupancy-grid ?message ?grid (padding ?padding))
    (lisp-fun occupancy-grid-msg->occupancy-grid ?message :padding ?padding :invert t ?grid)))
