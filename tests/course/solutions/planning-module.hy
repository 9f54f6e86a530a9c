(def-process-module turtlesim-planning [motion-designator]
  "planned")
(def-fact-group planning [available-process-module matching-process-module motion-grounding]
  (<- (cpm:available-process-module turtlesim-planning))
  (<- (cpm:matching-process-module ?desig turtlesim-planning)
    (desig-prop ?desig (type dreaming)))
  (<- (desig:motion-grounding ?desig ["dream"])
    (desig-prop ?desig (type dreaming))))
