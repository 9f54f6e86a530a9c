(require cramhy *)
(import . [motion-designators process-modules])

(def-fact-group available-turtle-process-modules [available-process-module
                                                  matching-process-module]
  ;; what the turtle has
  (<- (cpm:available-process-module turtlesim-navigation))
  (<- (cpm:available-process-module turtlesim-pen-control))

  ;; and what each part is good for
  (<- (cpm:matching-process-module ?desig turtlesim-navigation)
    (desig-prop ?desig (type driving)))
  (<- (cpm:matching-process-module ?desig turtlesim-navigation)
    (desig-prop ?desig (type moving)))
  (<- (cpm:matching-process-module ?desig turtlesim-navigation)
    (desig-prop ?desig (type going-to)))
  (<- (cpm:matching-process-module ?desig turtlesim-pen-control)
    (desig-prop ?desig (type setting-pen))))

(defn perform-some-motion [motion-desig]
  "Performs a motion with whichever process module is right for it."
  (top-level
    (with-process-modules-running [turtlesim-navigation turtlesim-pen-control]
      (exe:perform motion-desig))))
