//! Answers with and without skipping, and a ledger that is true.

use hadar::demand::Thing;
use hadar_evidence::accuracy::skipping::skipping;
use hadar_evidence::report::skipping_text;

#[test]
fn real_questions_have_the_same_answers_with_and_without_skipping() {
    let found = skipping(true).unwrap();
    println!("{}", skipping_text(&found));
    assert!(found.len() > 5);
    for one in &found {
        assert!(one.answers_equal, "{}: {}", one.scenario, one.question);
        for (thing, line) in serde_json::to_value(&one.work).unwrap().as_object().unwrap() {
            let spared = line["spared"].as_object().unwrap().values().map(|count| count.as_u64().unwrap());
            let accounted = line["computed"].as_u64().unwrap() + spared.sum::<u64>();
            assert_eq!(line["possible"], accounted, "{thing}");
        }
        assert!(one.seconds_on > 0.0 && one.seconds_off > 0.0);
    }
    let spared = |thing: Thing| found.iter().any(|one| one.work.computed(thing) < one.work.possible(thing));
    for thing in
        [Thing::NearestSearches, Thing::Windows, Thing::Samples, Thing::Trials, Thing::TrainedClassifiers]
    {
        assert!(spared(thing), "{thing:?}");
    }
    // Of local distances all are asked for, and no proof spares any.
    let last = &found[found.len() - 1].work;
    assert_eq!((last.possible(Thing::LocalDistances), last.computed(Thing::LocalDistances)), (20, 20));
}
