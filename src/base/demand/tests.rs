use super::*;
use crate::error::Error;
use crate::parallel;
use proptest::prelude::*;
use std::cell::Cell;

const THINGS: [Thing; 3] = [Thing::OwnStateDistances, Thing::FewBandSearches, Thing::NearestSearches];
const REASONS: [Reason; 3] = [Reason::NotAsked, Reason::OwnState, Reason::AnotherOne];

/// A ledger from a list of entries: thing, reason or none, count.
fn ledger(entries: &[(usize, usize, u64)]) -> Work {
    let mut work = Work::default();
    for &(thing, reason, count) in entries {
        match REASONS.get(reason) {
            Some(reason) => work.spare(THINGS[thing], *reason, count),
            None => work.compute(THINGS[thing], count),
        }
    }
    work
}

fn entries() -> impl Strategy<Value = Vec<(usize, usize, u64)>> {
    proptest::collection::vec((0..3_usize, 0..4_usize, 0..1_000_000_u64), 0..12)
}

proptest! {
    /// Grouping and order do not matter, and every line has the sum of what was booked.
    #[test]
    fn ledgers_add_in_any_order(a in entries(), b in entries(), c in entries()) {
        let [x, y, z] = [&a, &b, &c].map(|entries| ledger(entries));
        prop_assert_eq!(x.clone().and(&y).and(&z), x.clone().and(&y.clone().and(&z)));
        prop_assert_eq!(x.clone().and(&y), y.clone().and(&x));
        prop_assert_eq!(x.clone().and(&Work::default()), x.clone());
        let all = x.and(&y).and(&z);
        for (i, thing) in THINGS.into_iter().enumerate() {
            let booked = a.iter().chain(&b).chain(&c).filter(|entry| entry.0 == i);
            let (spared, computed): (Vec<_>, Vec<_>) = booked.partition(|entry| entry.1 < 3);
            let sum = |entries: &[&(usize, usize, u64)]| entries.iter().map(|entry| entry.2).sum::<u64>();
            prop_assert_eq!(all.computed(thing), sum(&computed));
            prop_assert_eq!(all.possible(thing), sum(&computed) + sum(&spared));
        }
    }
}

#[test]
fn what_is_not_asked_for_is_not_run() {
    let ledger = Ledger::open();
    let none = if_asked(false, Thing::Figures, 4, || -> Result<u8> {
        Err(Error::malformed("ran", "do not run it"))
    });
    assert_eq!(none.unwrap(), None);
    assert_eq!(if_asked(true, Thing::Figures, 2, || Ok(7)).unwrap(), Some(7));
    let work = ledger.close();
    assert_eq!((work.possible(Thing::Figures), work.computed(Thing::Figures)), (6, 2));
    assert_eq!(work.spared(Thing::Figures, Reason::NotAsked), 4);
}

/// What is booked goes to the innermost ledger that is open, and nowhere where none is; one that is left early or in
/// panic leaves the outer one as it was.
#[test]
fn ledgers_nest_and_keep_to_themselves() {
    let book = |count| computed(Thing::Windows, count);
    let of = |work: Work| work.computed(Thing::Windows);
    book(1);
    let outer = Ledger::open();
    book(2);
    let ((), inner) = ledger_of(|| {
        book(4);
        Ok(())
    })
    .unwrap();
    let fails = || -> Result<()> {
        book(8);
        Err(Error::malformed("failed", "try again"))
    };
    assert!(ledger_of(fails).is_err());
    let _ = std::panic::catch_unwind(|| {
        let _ledger = Ledger::open();
        book(16);
        panic!("left in the middle");
    });
    book(32);
    add(&inner);
    assert_eq!((of(inner), of(outer.close())), (4, 2 + 4 + 32));
    book(64);
    assert_eq!(Ledger::open().close(), Work::default());
}

/// Jobs that wait for jobs of their own, so that threads take up each other's.
#[test]
fn jobs_in_parallel_add_up_for_any_number_of_threads() {
    let task = |inner: u64| {
        computed(Thing::Samples, 1);
        Ok(inner)
    };
    let job = |outer: u64| {
        computed(Thing::Windows, 1);
        let found = parallel::booked(outer as usize, |inner| task(inner as u64))?;
        computed(Thing::Windows, 1);
        Ok(found.len() as u64)
    };
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let all = || parallel::booked(40, |outer| job(outer as u64));
        let (found, work) = pool.install(|| ledger_of(all)).unwrap();
        assert_eq!(found, (0..40).collect::<Vec<u64>>());
        assert_eq!((work.computed(Thing::Windows), work.computed(Thing::Samples)), (80, 780));
    }
}

/// Which of two proofs and the full way run, counted by themselves.
#[test]
fn a_proof_spares_what_comes_after_it_and_nothing_before() {
    for skipping in [Skipping::On, Skipping::Off] {
        for winner in 0..3 {
            let ran = [const { Cell::new(0_u64) }; 3];
            let tried = |i: usize| {
                let ran = &ran;
                move |_: &mut ()| {
                    ran[i].set(ran[i].get() + 1);
                    Ok((winner == i).then_some("answer").into())
                }
            };
            let (first, second) = (tried(0), tried(1));
            let proofs = [
                Proof { of: Some(THINGS[0]), spares: Reason::OwnState, find: &first },
                Proof { of: Some(THINGS[1]), spares: Reason::FewBands, find: &second },
            ];
            let in_full = |_: &mut ()| {
                ran[2].set(ran[2].get() + 1);
                Ok(("answer", None))
            };
            let (answer, work) =
                ledger_of(|| skipping.first_proof(&mut (), &proofs, THINGS[2], &in_full)).unwrap();
            assert_eq!(answer, "answer");
            for (i, thing) in THINGS.into_iter().enumerate() {
                assert_eq!(work.computed(thing), ran[i].get(), "{skipping:?} {winner} {i}");
                let asked = skipping == Skipping::On || i == 2;
                assert_eq!(work.possible(thing), u64::from(asked), "{skipping:?} {winner} {i}");
            }
        }
    }
}

/// What is not tried is not counted as computed, and stands in nobody's way.
#[test]
fn a_hopeless_proof_is_left_out() {
    let proof =
        Proof { of: Some(THINGS[1]), spares: Reason::FewBands, find: &|_: &mut ()| Ok(Attempt::NotTried) };
    let (answer, work) =
        ledger_of(|| Skipping::On.first_proof(&mut (), &[proof], THINGS[2], &|_| Ok((5, None)))).unwrap();
    assert_eq!((answer, work.computed(THINGS[2])), (5, 1));
    assert_eq!((work.computed(THINGS[1]), work.spared(THINGS[1], Reason::Hopeless)), (0, 1));
}

#[test]
fn the_first_item_that_settles_it_ends_the_work() {
    let things = [Thing::Windows, Thing::Samples];
    for (skipping, looked_at) in [(Skipping::On, 3), (Skipping::Off, 5)] {
        let settles = |item| {
            things.iter().for_each(|thing| computed(*thing, 1));
            Ok((item >= 2).then_some(item))
        };
        let (found, work) = ledger_of(|| skipping.until(0..5, &things, settles)).unwrap();
        assert_eq!(found, Some(2));
        for thing in things {
            assert_eq!((work.computed(thing), work.possible(thing)), (looked_at, 5));
        }
    }
    let (none, work) = ledger_of(|| Skipping::On.until(0..5, &things, |_| Ok(None::<u8>))).unwrap();
    assert_eq!((none, work.possible(Thing::Windows)), (None, 0));
}

#[test]
fn the_ledger_as_json() {
    let mut work = Work::default();
    work.compute(Thing::Windows, 1200);
    work.spare(Thing::Windows, Reason::ProvedAbove, 34_000);
    work.spare(Thing::Windows, Reason::ProvedBelow, 7);
    let line = serde_json::json!({
        "possible": 35_207,
        "computed": 1200,
        "spared": {"proved_above": 34_000, "proved_below": 7},
    });
    assert_eq!(serde_json::to_value(&work).unwrap(), serde_json::json!({ "windows": line }));
}
