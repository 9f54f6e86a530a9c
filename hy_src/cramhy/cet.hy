"The macros of CRAM-EXECUTION-TRACE (projection-and-events.md, part C)."

(require cramhy.operators [defoperator])
(import cramhy.operators *)

(setv package "CRAM-EXECUTION-TRACE")

(defoperator with-episode-knowledge [episode-knowledge #* body]
  `(%with-episode-knowledge ~episode-knowledge (lambda [] ~@body)))

(defoperator with-last-episode-knowledge [#* body]
  `(%with-last-episode-knowledge (lambda [] ~@body)))

(defoperator with-top-level-episode-knowledge [plan-name #* body]
  `(%with-top-level-episode-knowledge (quote ~plan-name) (lambda [] ~@body)))

(defoperator with-offline-episode-knowledge [source #* body]
  `(%with-offline-episode-knowledge ~source (lambda [] ~@body)))

(defoperator defstore-episode-knowledge-backend [parameters #* body]
  (setv #(object type stream) parameters)
  `(%define-episode-store (quote ~type) (lambda [~object ~stream] ~@body)))

(defoperator defrestore-episode-knowledge-backend [parameters #* body]
  (setv #(type stream) parameters)
  `(%define-episode-restore (quote ~type) (lambda [~stream] ~@body)))
