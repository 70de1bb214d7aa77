"""Order of the stages that make an object from stored sessions; free of ROS.

`jobs` offers list_sessions() and session(id) (objects with session_id, object_id, keyframe_count,
refined and segmented, marks with `by`) and the long jobs
refine(ids, progress), segment(id, progress), align(ids, require_all, progress) -> placements, left_out, note and
build(object_id, name, placements, left_out, replace, progress) -> built, note. All raise Failure. A note tells what a job
that succeeded could not do; else it is empty.
"""
from object_modelling.outcome import Code, Failure, check_id


def choose_sessions(jobs, object_id, session_ids, last_session_id):
    """Ids of the sessions to build from; NOT_FOUND and FAILED_PRECONDITION name what is missing."""
    check_id("object id", object_id)
    if session_ids:
        repeated = {session_id for session_id in session_ids if session_ids.count(session_id) > 1}
        if repeated:
            raise Failure(Code.INVALID_ARGUMENT, "sessions named twice: %s" % ", ".join(sorted(repeated)))
        sessions = [jobs.session(session_id) for session_id in session_ids]
    else:
        sessions = _sessions_of(jobs, object_id, last_session_id)
    empty = [session.session_id for session in sessions if session.keyframe_count == 0]
    if empty:
        raise Failure(
            Code.FAILED_PRECONDITION,
            "session '%s' has no keyframes: record it again with the object in view, or discard_session" % empty[0],
        )
    return [session.session_id for session in sessions]


def _sessions_of(jobs, object_id, last_session_id):
    stored = jobs.list_sessions()
    own = [session for session in stored if session.object_id == object_id]
    if own:
        return own
    last = [session for session in stored if session.session_id == last_session_id and not session.object_id]
    if last:
        return last
    names = ", ".join(session.session_id for session in stored) or "none"
    raise Failure(
        Code.NOT_FOUND,
        "object '%s' has no session: record one with start_session and stop_session, or name the sessions "
        "(stored: %s)" % (object_id, names),
    )


def build(jobs, request, session_ids, progress, clock):
    """Runs all stages; returns (built, [(stage, seconds)], note). progress(stage, step, done, total) may raise Failure to
    cancel: a stage then leaves the store as it was. `request`: object_id, name, replace, again, require_all, as in
    srv/BuildObject.srv. Sessions that were refined or segmented already are so only `again` on request: a person may have
    chosen the object. Sessions that do not fit make the object partial, unless all are required."""
    times = []

    def run(stage, job):
        progress(stage, "", 0, 0)
        start = clock()
        result = job(lambda step, done, total: progress(stage, step, done, total))
        times.append((stage, clock() - start))
        return result

    def pending(is_done, report):
        left = [name for name in session_ids if request.again or not is_done(jobs.session(name))]
        done = [name for name in session_ids if name not in left]
        if done:
            report("as before: " + ", ".join(done), 0, 0)
        return left

    def refine(report):
        unrefined = pending(lambda session: session.refined.by, report)
        if unrefined:
            jobs.refine(unrefined, report)

    def segment(report):
        unsegmented = pending(lambda session: session.segmented.by, report)
        for index, session_id in enumerate(unsegmented):
            prefix = "" if len(unsegmented) == 1 else "%d of %d, " % (index + 1, len(unsegmented))
            jobs.segment(session_id, lambda step, done, total: report(prefix + step, done, total))

    run("refine", refine)
    run("segment", segment)
    placements, left_out, why_left_out = run(
        "align", lambda report: jobs.align(session_ids, request.require_all, report))
    try:
        built, unfinished = run("build", lambda report: jobs.build(
            request.object_id, request.name, placements, left_out, request.replace, report))
    except Failure as failure:
        if left_out and failure.code != Code.CANCELLED:
            raise Failure(failure.code, "%s; %s" % (failure.message, why_left_out)) from failure
        raise
    # First that the object is partial, then why and what to do.
    return built, times, "; ".join(note for note in (unfinished, why_left_out) if note)
