(require cramhy *)
(import .control-turtlesim [turtle-pose])

(defn get-shape-vertices [type #* parameters]
  "The corners of a shape as lists [x y 0], in the order in which they are visited.
  The turtle's present position is the lower left corner, and the last in the list.
  `parameters' are base width and height of a triangle, width and height of a rectangle."
  (with-fields [x y] turtle-pose.value
    (defn corner [right up]
      [(+ x right) (+ y up) 0])
    (match type
      "triangle"
        (let [[base-width height] parameters]
          [(corner base-width 0)
           (corner (/ base-width 2) height)
           (corner 0 0)])
      "rectangle"
        (let [[width height] parameters]
          [(corner width 0)
           (corner width height)
           (corner 0 height)
           (corner 0 0)]))))

(def-fact-group turtle-action-designators [action-grounding]
  ;; for each kind of action, the plan that does it and what this plan is called with

  (<- (desig:action-grounding ?desig [draw-house])
    (desig-prop ?desig (type drawing))
    (desig-prop ?desig (shape house)))

  (<- (desig:action-grounding ?desig [draw-simple-shape ?vertices])
    (desig-prop ?desig (type drawing))
    (desig-prop ?desig (shape rectangle))
    (desig-prop ?desig (width ?width))
    (desig-prop ?desig (height ?height))
    (lisp-fun get-shape-vertices "rectangle" ?width ?height ?vertices))

  (<- (desig:action-grounding ?desig [draw-simple-shape ?vertices])
    (desig-prop ?desig (type drawing))
    (desig-prop ?desig (shape triangle))
    (desig-prop ?desig (base-width ?base-width))
    (desig-prop ?desig (height ?height))
    (lisp-fun get-shape-vertices "triangle" ?base-width ?height ?vertices))

  (<- (desig:action-grounding ?desig [navigate ?target])
    (desig-prop ?desig (type navigating))
    (desig-prop ?desig (target ?target))))
