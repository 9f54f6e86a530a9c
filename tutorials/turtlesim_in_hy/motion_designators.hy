(require cramhy *)
(import dataclasses [dataclass])

(defclass [dataclass] TurtleMotion []
  "How to drive: speed ahead and angle of turning, both per second."
  (setv #^ float speed 0)
  (setv #^ float angle 0))

(defn goal-vector [goal]
  "The 3d-vector for a goal (x y z)."
  (make-3d-vector #* goal))

(def-fact-group turtle-motion-designators [motion-grounding]
  ;; for each kind of motion, check for and extract the necessary info

  ;; drive and turn
  (<- (desig:motion-grounding ?desig ["drive" ?motion])
    (desig-prop ?desig (type driving))
    (desig-prop ?desig (speed ?speed))
    (desig-prop ?desig (angle ?angle))
    (lisp-fun TurtleMotion :speed ?speed :angle ?angle ?motion))

  ;; drive
  (<- (desig:motion-grounding ?desig ["drive" ?motion])
    (desig-prop ?desig (type driving))
    (desig-prop ?desig (speed ?speed))
    (lisp-fun TurtleMotion :speed ?speed ?motion))

  ;; turn
  (<- (desig:motion-grounding ?desig ["drive" ?motion])
    (desig-prop ?desig (type driving))
    (desig-prop ?desig (angle ?angle))
    (lisp-fun TurtleMotion :angle ?angle ?motion))

  ;; move
  (<- (desig:motion-grounding ?desig ["move" ?motion])
    (desig-prop ?desig (type moving))
    (desig-prop ?desig (goal ?goal))
    (lisp-fun goal-vector ?goal ?motion)))

(defclass [dataclass] PenMotion []
  "How to draw: colour, width in pixels, and 1 for off when the pen is lifted."
  (setv #^ int r 255)
  (setv #^ int g 255)
  (setv #^ int b 255)
  (setv #^ int width 1)
  (setv #^ int off 0))

(def-fact-group turtle-pen-motion-designators [motion-grounding]
  ;; colour, width, and whether it draws
  (<- (desig:motion-grounding ?desig ["set-pen" ?motion])
    (desig-prop ?desig (type setting-pen))
    (desig-prop ?desig (r ?r))
    (desig-prop ?desig (g ?g))
    (desig-prop ?desig (b ?b))
    (desig-prop ?desig (width ?width))
    (desig-prop ?desig (off ?off))
    (lisp-fun PenMotion :r ?r :g ?g :b ?b :width ?width :off ?off ?motion))

  ;; colour and width
  (<- (desig:motion-grounding ?desig ["set-pen" ?motion])
    (desig-prop ?desig (type setting-pen))
    (desig-prop ?desig (r ?r))
    (desig-prop ?desig (g ?g))
    (desig-prop ?desig (b ?b))
    (desig-prop ?desig (width ?width))
    (lisp-fun PenMotion :r ?r :g ?g :b ?b :width ?width ?motion))

  ;; up or down
  (<- (desig:motion-grounding ?desig ["set-pen" ?motion])
    (desig-prop ?desig (type setting-pen))
    (desig-prop ?desig (off ?off))
    (lisp-fun PenMotion :off ?off ?motion)))

(def-fact-group goal-motions [motion-grounding]
  ;; to a place that has a description
  (<- (desig:motion-grounding ?desig ["go-to" ?point])
    (desig-prop ?desig (type going-to))
    (desig-prop ?desig (goal ?point))))
