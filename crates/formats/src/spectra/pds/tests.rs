use super::super::damage::rows;
use super::*;

const LABEL: &str = r#"<?xml version="1.0"?>
<Product_Observational xmlns="http://pds.nasa.gov/pds4/pds/v1" xmlns:speclib="http://pds.nasa.gov/pds4/speclib/v1">
 <Identification_Area><logical_identifier>urn:nasa:pds:relab:data_reflectance:c1ls04</logical_identifier>
  <title>RELAB Spectrum ID c1ls04</title></Identification_Area>
 <speclib:specimen_name>Roof tile, ground</speclib:specimen_name>
 <File_Area_Observational><File><file_name>c1ls04.tab</file_name></File>
  <Table_Character><offset unit="byte">4</offset><records>3</records>
   <Record_Character><fields>3</fields><record_length unit="byte">29</record_length>
    <Field_Character><name>Wavelength</name><field_location unit="byte">1</field_location><field_length unit="byte">8</field_length><unit>nm</unit></Field_Character>
    <Field_Character><name>Reflectance</name><field_location unit="byte">10</field_location><field_length unit="byte">8</field_length>
     <Special_Constants><missing_constant>-9.0</missing_constant></Special_Constants></Field_Character>
    <Field_Character><name>Standard Deviation</name><field_location unit="byte">19</field_location><field_length unit="byte">8</field_length></Field_Character>
   </Record_Character></Table_Character></File_Area_Observational>
</Product_Observational>
"#;
const TABLE: &str =
    "3 \r\n  8000.0  0.10000  0.00100\r\n 10000.0  0.20000  0.00100\r\n 12500.0  0.40000  0.00100\r\n";

#[test]
fn a_table_is_read_by_the_label_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let (tab, xml) = (folder.path().join("c1ls04.tab"), folder.path().join("c1ls04.xml"));
    std::fs::write(&tab, TABLE).unwrap();
    std::fs::write(&xml, LABEL).unwrap();
    let due = [(800.0, 0.6), (1000.0, 0.8), (1250.0, 0.9)];
    for path in [&tab, &xml] {
        let read = super::super::content_of_file(path, &Reading::default());
        assert_eq!(rows(read), [due], "{}", path.display());
    }
    let material = super::super::material(&xml).unwrap();
    assert_eq!(
        (material.name(), material.read_as()),
        ("roof-tile-ground", "PDS4, wavelength in nm, reflectance")
    );
    assert!(material.warnings().iter().any(|warning| warning.contains("RELAB")), "{:?}", material.warnings());
    for (table, label, part) in [
        (
            TABLE.replace(" 12500.0  0.40000  0.00100\r\n", ""),
            LABEL.to_owned(),
            "2 records where the label announces 3",
        ),
        (TABLE.replace("0.20000", "0.2x000"), LABEL.to_owned(), "`0.2x000`"),
        (
            TABLE.to_owned(),
            LABEL.replace("<name>Reflectance", "<name>Radiance"),
            "fields Wavelength, Radiance",
        ),
        (TABLE.to_owned(), LABEL.replace("<records>3", "<records>x"), "`x` as records"),
        (
            TABLE.to_owned(),
            LABEL.replace("Table_Character", "Table_Binary"),
            "not of one table of characters",
        ),
    ] {
        std::fs::write(&tab, table).unwrap();
        std::fs::write(&xml, label).unwrap();
        let message = super::super::from_file(&tab).unwrap_err().to_string();
        assert!(message.contains(part) && message.contains("c1ls04.tab"), "{message}");
    }
    // What is missing is not known; a label does not lead out of its folder.
    std::fs::write(&tab, TABLE.replace(" 0.40000", "-9.00000")).unwrap();
    std::fs::write(&xml, LABEL).unwrap();
    assert_eq!(super::super::from_file(&tab).unwrap()[0].rows(), 2);
    assert!(table_of(&LABEL.replace("c1ls04.tab", "../c1ls04.tab"), &xml).is_err());
}

proptest::proptest! {
    #![proptest_config(hadar_testing::seeded(46, 256))]

    #[test]
    fn no_label_makes_the_reader_panic(at in 0_usize..LABEL.len(), length in 0_usize..40, body in "[<>/a-z0-9 :]{0,12}") {
        let end = (at + length).min(LABEL.len());
        let label = format!("{}{body}{}", &LABEL[..at], &LABEL[end..]);
        drop(parse(TABLE, &label, Path::new("a.tab"), &Reading::default()).and_then(Content::materials));
    }
}
