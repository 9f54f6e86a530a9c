(require cramhy *)
(import math [cos sin radians dist]
        cram-plan-occasions-events
        cramhy [robot]
        cramhy.robot [at]
        cramhy_runtime.robot.worlds [text]
        .kitchen [kitchen]
        .moving-a-bottle [before-counter bottle-on-counter get-ready]
        .recovering [deliver fetch find-thing])

(setv table-top 0.746                                ; how high the dining table is, in metres
      beside-table (robot.at -2.2 1.9 :yaw -125)     ; where the robot stands when it is done
      camera [[-0.6 -0.5 2.5] [-2.9 0.7 0.6]])       ; from where the table is seen: the eye, and where it looks

(defn place-before [x y direction ahead left up]
  "The pose on the table that is so far ahead and to the left of a guest."
  (setv angle (radians direction))
  (robot.at (+ x (- (* ahead (cos angle)) (* left (sin angle))))
            (+ y (+ (* ahead (sin angle)) (* left (cos angle))))
            (+ table-top up)
            :yaw direction))

(def-fact-group table-for-two [seat cover belongs]

  ;; where a guest sits at the table, and in which direction he looks
  (<- (seat :left -3.28 -0.33 90))
  (<- (seat :right -3.28 0.95 -90))

  ;; what each guest needs: how far before him it is, how far to his left, and how high its middle is above the table
  (<- (cover :bowl 0.27 0 0.04))
  (<- (cover :spoon 0.27 -0.12 0.01))
  (<- (cover :cup 0.42 0.12 0.05))

  ;; what belongs on the table, and where: a cover for each guest, and a bottle for both
  (<- (belongs ?type ?pose)
    (seat ?guest ?x ?y ?direction)
    (cover ?type ?ahead ?left ?up)
    (lisp-fun place-before ?x ?y ?direction ?ahead ?left ?up ?pose))
  (<- (belongs :bottle ?pose)
    (lisp-fun at -3.28 0.31 0.85 ?pose)))

(defn what-belongs []
  "Pairs of a type of thing and the pose on the table where one belongs."
  (lfor solution (force-ll (prolog '(belongs ?type ?pose)))
    #((text (var-value '?type solution)) (var-value '?pose solution))))

(defn there-p [type pose]
  "Whether a thing of that type is at a pose, or less than five centimetres away from it."
  (any (gfor name (kitchen.names)
         (and (.startswith name type)
              (< (dist (kitchen.place name) #(pose.origin.x pose.origin.y pose.origin.z)) 0.05)))))

(defn in-hand [type]
  "The designator of a thing of that type which the robot holds, or None."
  (for [solution (prolog '(cram-plan-occasions-events:object-in-hand ?thing))]
    (setv thing (current-desig (var-value '?thing solution)))
    (when (= (text (get thing "type")) type)
      (return thing))))

(defn search-counter [type]
  "Goes to the counter and finds a thing of that type there."
  (robot.go before-counter)
  (find-thing type bottle-on-counter))

(defn bring [type place]
  "Brings a thing of that type from the counter, or from the robot's hand, to a place."
  (ros-info (kitchen) "Bringing a ~a." type)
  (deliver (or (in-hand type)
               (fetch (search-counter type)))
           place))

(defn set-table []
  "Brings what belongs on the table and is not there yet."
  (get-ready)
  (for [[type place] (what-belongs)]
    (when (not (there-p type place))
      (bring type place)))
  (robot.go beside-table))

(setv blue #(0.3 0.45 0.8)
      orange #(0.9 0.5 0.2)
      green #(0.2 0.5 0.25)
      dishes [["bowl" 0.2 blue] ["bowl" 0.42 orange]
              ["cup" 0.62 blue] ["cup" 0.78 orange]
              ["spoon" 0.95 blue] ["spoon" 1.1 orange]
              ["bottle" -0.05 green]])  ; type, place along the counter and colour of what a table for two needs

(defn lay-out-dishes []
  "Puts the dishes onto the counter."
  (for [[type y colour] dishes]
    (kitchen.spawn type (robot.at 1.42 y 0.96) :colour colour))
  (kitchen.settle))

(defn set-table-for-two []
  "Sets the table with the dishes on the counter."
  (robot.run set-table))
