"Draws what lecture 38 draws, and a house, in virtual time: `hy draw.hy [PICTURE]`.

The name of the picture ends in .svg or .png, or in .gif or .replay.svg for a replay of the whole way."

(require cramhy *)
(cramhy.time "virtual")  ; which passes as fast as the machine computes

(import pathlib [Path]
        random
        sys
        cramhy_runtime.turtlesim.pictures [check is-replay keep-history save])

(sys.path.insert 0 (str (. (Path __file__) (resolve) parent parent)))  ; the package lies there, wherever it was copied to
(import turtlesim-in-hy.control-turtlesim [call-set-pen]
        turtlesim-in-hy.high-level-plans [perform-draw-house]
        turtlesim-in-hy.process-modules [init drive move-parallel drive-n-draw])

(defn draw []
  "The plans of lecture 38, one after the other, and then the house."
  (init)
  (drive 5 2)
  (sleep 1.5)
  (move-parallel)
  (sleep 1.5)
  (drive-n-draw 9 9)
  (call-set-pen 255 255 255 1 0)
  (perform-draw-house))

(defn main [[picture "turtle.svg"]]
  (check picture)
  (when (is-replay picture) (keep-history))
  (random.seed 38)
  (draw)
  (save picture)
  (print f"The turtle's paper is in {(.resolve (Path picture))}"))

(when (= __name__ "__main__")
  (main #* (cut sys.argv 1 None)))
