(defn square-action [?side]
  (desig:an action (type drawing) (shape rectangle) (width ?side) (height ?side)))
