use super::*;

const BOX: Shape = Shape::Cuboid { low: [-1.0, 0.0, 5.0], high: [1.0, 2.0, 9.0] };
const EGG: Shape = Shape::Ellipsoid { centre: [0.0, 1.0, 8.0], semi: [0.5, 1.0, 2.0] };
const LIMB: Shape = Shape::Capsule { ends: [[0.0, 0.5, 4.0], [0.0, 2.5, 4.0]], radius: 0.3 };

#[test]
fn rays_meet_solids_where_they_should() {
    let from = [0.0, 1.0, 0.0];
    let ahead = [0.0, 0.0, 1.0];
    assert_eq!(BOX.hit(from, ahead), Some(5.0));
    assert_eq!(EGG.hit(from, ahead), Some(6.0));
    assert!((LIMB.hit(from, ahead).unwrap() - 3.7).abs() < 1e-15);
    // Aside by 0.3 of the semi-axis 0.5: depth 8 − 2√(1 − 0.36).
    let aside = EGG.hit([0.3, 1.0, 0.0], ahead).unwrap();
    assert!((aside - (8.0 - 2.0 * 0.8)).abs() < 1e-14);
    // The cap of a capsule: 0.18 above its end and 0.24 before the axis.
    let cap = LIMB.hit([0.0, 2.68, 0.0], ahead).unwrap();
    assert!((cap - 3.76).abs() < 1e-14);
    for shape in [BOX, EGG, LIMB] {
        assert_eq!(shape.hit(from, [0.0, 0.0, -1.0]), None);
        assert_eq!(shape.hit([0.0, 5.0, 0.0], ahead), None);
    }
}

#[test]
fn a_hit_is_on_the_surface_and_its_normal_faces_the_ray() {
    for shape in [BOX, EGG, LIMB] {
        let mut hits = 0;
        for i in 0..400 {
            let direction = [f64::from(i % 20) / 50.0 - 0.19, f64::from(i / 20) / 50.0 - 0.19, 1.0];
            let Some(t) = shape.hit([0.1, 1.2, 0.0], direction) else { continue };
            let point = along([0.1, 1.2, 0.0], t, direction);
            let normal = shape.normal(point);
            assert!((norm(normal) - 1.0).abs() < 1e-12);
            assert!(dot(normal, direction) < 1e-7);
            assert!(
                shape.contains(along(point, -1e-9, normal)) && !shape.contains(along(point, 1e-9, normal))
            );
            hits += 1;
        }
        assert!(hits > 20, "{hits}");
    }
}

#[test]
fn patches_add_up_to_the_area() {
    let area = |shape: Shape, n| shape.patches(n).iter().map(|p| p.area_m2).sum::<f64>();
    assert!((area(BOX, 3) / (2.0 * (2.0 * 2.0 + 2.0 * 4.0 + 2.0 * 4.0)) - 1.0).abs() < 1e-12);
    assert!((area(LIMB, 3) / (4.0 * PI * 0.09 + 2.0 * PI * 0.3 * 2.0) - 1.0).abs() < 1e-12);
    // Thomsen's formula for ellipsoids is within 1.1 %; a spheroid has a closed form.
    let spheroid = Shape::Ellipsoid { centre: [0.0; 3], semi: [0.5, 0.5, 1.0] };
    let e = (1.0 - 0.25_f64).sqrt();
    let exact = 2.0 * PI * 0.25 * (1.0 + e.asin() / (0.5 * e));
    assert!((area(spheroid, 32) / exact - 1.0).abs() < 1e-3);
    for shape in [BOX, EGG, LIMB] {
        for patch in shape.patches(4) {
            assert!(dot(patch.normal, shape.normal(patch.point)) > 1.0 - 1e-9);
        }
        // A closed surface: ∮ n dA = 0, and ∮ x·n dA = 3 × volume > 0.
        let sum = shape.patches(8).iter().fold([0.0; 3], |s, p| along(s, p.area_m2, p.normal));
        assert!(norm(sum) < 1e-9);
    }
}
