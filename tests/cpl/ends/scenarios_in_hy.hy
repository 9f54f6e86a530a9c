;; Some of the plans of scenarios.py in Hy, under the same names. Each is a function of note.
(require cramhy *)
(import cramhy-runtime [cpl]  .scenarios [KEPT])

(defn swallowing [[seconds 10.0]]
  (try (cpl.sleep seconds)
       (except [BaseException])))

(defn bare-except [note]
  (with [limit (cpl.move-on-after 1)]
    (swallowing)
    (note "swallowed")
    (cpl.sleep 100)
    (note "never"))
  (note limit.expired))

(defn a-loop-that-continues [note]
  (with [limit (cpl.move-on-after 1)]
    (for [_ (range 50)]
      (try (cpl.sleep 10)
           (except [BaseException] (continue))))
    (cpl.sleep 1))
  (note limit.expired))

(defn timeout-that-is-swallowed [note]
  (try (with [_ (cpl.timeout 1)]
         (swallowing)
         (cpl.sleep 100))
       (except [failure cpl.TimedOut] (note "TimedOut"))))

(defn body-of-pursue [note]
  (with [race (cpl.pursue)]
    (race.start (fn [] (cpl.sleep 1) "won"))
    (swallowing)
    (cpl.sleep 100)
    (note "never"))
  (note race.result))

(defn cleanup-that-waits-is-run-to-its-end [note]
  (with [limit (cpl.move-on-after 1)]
    (try (cpl.sleep 10)
         (finally
           (note "cleanup begins")
           (cpl.sleep 1)
           (par (cpl.sleep 1) (cpl.sleep 0.5))
           (note "cleanup ends"))))
  (note limit.expired))

(defn outer-deadline-first [note]
  (with [outer (cpl.move-on-after 1)]
    (with [inner (cpl.move-on-after 5)]
      (swallowing)
      (cpl.sleep 100))
    (note "never"))
  (note inner.expired)
  (note outer.expired))

(defn evaporated-while-the-block-unwinds [note]
  (defn task []
    (with [_ (cpl.move-on-after 1)]
      (try (cpl.sleep 10)
           (except [BaseException]
             (cpl.sleep 2)
             (note "cleanup")))
      (cpl.sleep 100)
      (note "never"))
    (cpl.sleep 100)
    (note "never, too"))
  (with [branches (cpl.par)]
    (setv started (branches.start task))
    (cpl.sleep 2)
    (started.evaporate))
  (note started.status.name))

(defn ticking [note [limit 5.0]]
  (with [_ (cpl.move-on-after limit)]
    (while True
      (cpl.sleep 1)
      (yield (cpl.now)))))

(defn generator-that-nobody-closes [note]
  (setv ticks (ticking note))
  (KEPT.append ticks)
  (next ticks)
  (note "first")
  (cpl.sleep 1))

(defn generator-whose-time-is-over-elsewhere [note]
  (setv ticks (ticking note))
  (next ticks)
  (note "first")
  (cpl.sleep 100)
  (note "never"))

(defn two-generators-in-turn [note]
  (setv one (ticking note 2.5)  two (ticking note))
  (note f"{(next one)} {(next two)}")
  (for [_ one] (note "never"))
  (note "never"))

(defn time-limit-that-is-swallowed [note]
  (while (< (cpl.now) 100)
    (swallowing)))
