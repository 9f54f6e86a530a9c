(setv side 4)
(setv around (* 4 side))
