(def-fact-group my-matches [matching-process-module]
  (<- (cpm:matching-process-module ?desig turtlesim-navigation)
    (desig-prop ?desig (type dancing))))
