use super::*;
use crate::parallel;
use rayon::prelude::*;
use std::sync::atomic::AtomicUsize;

/// Sums that check: of k numbers, k checks.
fn sum(most: u64) -> u64 {
    (1..=most).inspect(|_| check()).sum()
}

#[test]
fn work_ends_at_the_check_that_it_is_stopped_at_and_may_be_done_again() {
    for number in 1..=20 {
        let stop = Stop::at_check(number);
        let stopped = within(&stop, || sum(20)).unwrap_err();
        assert_eq!((stopped.reason, stop.checks()), (Reason::Interrupted, number));
        // What is done without it is not concerned.
        assert_eq!(sum(20), 210);
    }
    let counting = Stop::at_check(0);
    assert_eq!((within(&counting, || sum(20)), counting.checks()), (Ok(210), 20));
    let later = Stop::at_check(21);
    assert_eq!(within(&later, || sum(20)), Ok(210));
}

#[test]
fn each_question_is_stopped_by_its_own() {
    let [one, two] = [Stop::new(), Stop::new()];
    one.now(Reason::NobodyListens);
    one.now(Reason::TimeLimit);
    assert_eq!(one.said(), Some(Reason::NobodyListens), "the first reason holds");
    assert_eq!(within(&two, || sum(9)), Ok(45));
    // The inner one's end is not the outer one's, and the outer one's goes through the inner one.
    let inner = within(&two, || within(&one, || sum(9)).unwrap_err().reason);
    assert_eq!(inner, Ok(Reason::NobodyListens));
    let outer = within(&one, || {
        let inside = within(&two, || sum(9));
        check();
        inside
    });
    assert_eq!(outer.unwrap_err().by, one);
}

#[test]
fn threads_of_its_own_are_stopped_with_it() {
    for threads in [1, 2, 5] {
        let stop = Stop::new();
        let pool = stop.own_threads(threads).unwrap();
        assert_eq!(within(&stop, || pool.install(|| parallel::map(9, |i| sum(i as u64)))).unwrap().len(), 9);
        let begun = AtomicUsize::new(0);
        let endless = |i: usize| {
            if begun.fetch_add(1, Relaxed) == 0 {
                stop.now(Reason::MemoryLimit);
            }
            sum(u64::MAX) + i as u64
        };
        let stopped = within(&stop, || pool.install(|| parallel::map(1000, endless)));
        assert_eq!(stopped.unwrap_err().reason, Reason::MemoryLimit);
        let by_iterators = within(&stop, || {
            pool.install(|| (0..100_usize).into_par_iter().map(endless).collect::<Vec<_>>())
        });
        assert!(by_iterators.is_err());
    }
}

#[test]
fn a_pool_works_for_whom_it_is_lent_to() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    let stop = Stop::new();
    stop.now(Reason::Interrupted);
    for lent in [true, false, true] {
        let _lent = lent.then(|| stop.lend(&pool));
        let sums = within(&stop, || pool.install(|| parallel::map(9, |i| sum(i as u64))));
        assert_eq!(sums.is_err(), lent);
    }
}

#[test]
fn other_panics_are_other_peoples() {
    let stop = Stop::new();
    let panics = || resume_unwind(Box::new("on purpose"));
    assert_eq!(unless_it_panics(panics), None::<()>);
    let caught = catch_unwind(AssertUnwindSafe(|| within(&stop, panics))).unwrap_err();
    assert!(caught.downcast_ref::<&str>().is_some());
    stop.now(Reason::Terminated);
    assert!(within(&stop, || unless_it_panics(|| sum(3))).is_err(), "that it was stopped goes on");
    // A destructor that checks while work unwinds does not stop it once more.
    struct Checks;
    impl Drop for Checks {
        fn drop(&mut self) {
            check();
        }
    }
    let caught = catch_unwind(AssertUnwindSafe(|| {
        within(&stop, || {
            let _checks = Checks;
            panics()
        })
    }));
    assert!(caught.unwrap_err().downcast_ref::<&str>().is_some());
}
